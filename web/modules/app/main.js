// The page: which view is shown, and what is there in every view (status, STOP, what the bench asks for, token).

import { benchView } from "../bench/bench.js";
import { replace } from "../ui/dom.js";
import { learnView } from "../learn/learn.js";
import { Live } from "./live.js";
import { promptBar } from "./prompt.js";
import { statusBar } from "./status.js";
import { stopButton } from "./stop.js";
import { studiesView } from "../studies/studies.js";
import { tokenForm } from "./token.js";
import { trialsView } from "../trials/trials.js";
import { queueView } from "../queue/view.js";

const VIEWS = { bench: benchView, queue: queueView, trials: trialsView, study: studiesView, learn: learnView };
const live = new Live();
let leave = () => {};

function show() {
  const [name, ...rest] = location.hash.slice(1).split("/");
  const view = VIEWS[name] ?? benchView;
  for (const link of document.querySelectorAll(".tabs a")) {
    const current = (VIEWS[link.hash.slice(1)] ?? null) === view;
    if (current) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  leave();
  const place = replace(document.getElementById("view"));
  leave = view(place, { live, rest }) ?? (() => {});
}

stopButton(document.getElementById("stop"), document.getElementById("stop-answer"));
statusBar(document.getElementById("status"), live);
promptBar(document.getElementById("prompt"), live);
tokenForm(document.getElementById("token"));
addEventListener("hashchange", show);
show();
live.run();
