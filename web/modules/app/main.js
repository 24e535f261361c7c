// The page: which view is shown, and what is there in every view (status, STOP, what the bench asks for, token, units).

import { benchView } from "../bench/bench.js";
import { commission } from "../commission/commission.js";
import { homeView } from "../home/home.js";
import { learnView } from "../learn/learn.js";
import { numbers } from "../numbers/numbers.js";
import { queueView } from "../queue/view.js";
import { studiesView } from "../studies/studies.js";
import { beginTour, tour } from "../tour/tour.js";
import { trialsView } from "../trials/trials.js";
import { h, panel, replace } from "../ui/dom.js";
import { unitSwitch } from "../ui/units.js";
import { versusView } from "../versus/versus.js";
import { here } from "./address.js";
import { Live } from "./live.js";
import { promptBar } from "./prompt.js";
import { BenchState } from "./state.js";
import { statusBar } from "./status.js";
import { stopButton } from "./stop.js";
import { tokenForm } from "./token.js";

// by the name in the address; a view with a tab stands in the row at the top, one with a text is linked to by the view `from`
const VIEWS = {
  "": { open: homeView },
  home: { open: homeView },
  bench: { open: benchView, tab: "Bench" },
  commission,
  queue: { open: queueView, tab: "Queue" },
  trials: { open: trialsView, tab: "Trials" },
  study: { open: studiesView, tab: "Study" },
  numbers,
  compare: { open: versusView },
  learn: { open: learnView, tab: "Learn" },
  tour: { open: beginTour },
};
const live = new Live();
const state = new BenchState(live);
let leave = () => {};

function show() {
  const { view, rest, query } = here();
  for (const link of document.querySelectorAll(".tabs a")) {
    if (link.hash === `#${view}`) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  document.body.dataset.view = view || "home";
  leave();
  const place = replace(document.getElementById("view"));
  place.className = "";
  leave = (Object.hasOwn(VIEWS, view) ? VIEWS[view].open : unknownView)(place, { live, state, rest, query, links: linksFrom(view) }) ?? (() => {});
}

function tabs(row) {
  row.prepend(...Object.entries(VIEWS).filter(([, { tab }]) => tab).map(([name, { tab }]) => h("a", { href: `#${name}` }, tab)));
}

function linksFrom(view) {
  return Object.entries(VIEWS).filter(([, { from }]) => from === view).map(([name, { text }]) => h("p", {}, h("a", { href: `#${name}` }, text)));
}

function unknownView(place) {
  replace(place, panel("There is no such page", h("p", {}, `The address ${location.hash} leads nowhere.`), h("p", {}, h("a", { href: "#home" }, "To the first page"))));
}

stopButton(document.getElementById("stop"), document.getElementById("stop-answer"), state);
statusBar(document.getElementById("status"), state);
promptBar(document.getElementById("prompt"), live);
tokenForm(document.getElementById("token"));
tour(document.getElementById("tour"), live);
unitSwitch(document.getElementById("units"), show);
tabs(document.getElementById("tabs"));
addEventListener("hashchange", show);
show();
live.run();
