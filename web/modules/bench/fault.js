// A fault that the drive holds on to: read, shown, and cleared when the person says that its cause is gone.

import { post } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";

export function faultPanel(place, live) {
  const [found, answer] = [h("div"), h("div")];
  const read = h("button", { type: "button", class: "small", onclick: () => attempt(answer, async () => show(await post("/drive/state")), { button: read }) }, "Read the drive's state");
  const show = (states) => replace(found, ...states.drives.map(line), states.fault ? clearing(states.fault) : null);
  const clearing = (fault) => {
    const clear = h("button", {
      type: "button", class: "small",
      onclick: () => attempt(answer, async () => {
        show(await post("/drive/clear-fault", { fault }));
        found.append(h("p", { role: "status" }, `Cleared: ${fault}. The power is off.`));
      }, { button: clear }),
    }, "Its cause is removed: clear the fault");
    return h("p", {}, clear);
  };
  const rest = () => { read.disabled = live.status?.state === "running"; };
  replace(place, read, found, answer);
  live.addEventListener("status", rest);
  rest();
  return () => live.removeEventListener("status", rest);
}

function line(drive) {
  const name = drive.joint === "joint" ? "" : `${drive.joint}: `;
  const off = drive.torque_off ? `safe torque off is active (${drive.torque_off}); the joint is not at fault: release the emergency stop or the guard` : "";
  const said = drive.fault ? `fault: ${drive.fault}` : drive.state || "no fault";
  return h("p", { class: drive.fault || off ? "problem" : "" }, `${name}${drive.device}: ${[said, off].filter(Boolean).join("; ")}`);
}
