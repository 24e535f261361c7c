// Recording sets of other benches come in: a zip, all of it or nothing.

import { upload } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";

// done(made): it is in the store; open: whether its fields are shown at once
export function importForm(done, open = false) {
  const file = h("input", { type: "file", accept: ".zip", id: "import-file", required: true });
  const name = h("input", { id: "import-name" });
  const answer = h("div");
  const button = h("button", {}, "Import");
  const submit = async (event) => {
    event.preventDefault();
    const [chosen] = file.files;
    const query = { name: name.value || chosen.name.replace(/\.zip$/i, "") };
    const result = await attempt(answer, () => upload("/recording-sets", chosen, query), { button });
    if (!result) return;
    replace(answer, h("div", { class: "good", role: "status" }, `Imported ${result.trials} trials as experiment ${result.experiment_id}.`));
    done(result);
  };
  return h("details", { open }, h("summary", {}, "Import a recording set"), h("form", { class: "row", onsubmit: submit },
    h("label", { for: "import-file" }, "Recording set (.zip)", file), h("label", { for: "import-name" }, "Name (optional)", name), button), answer);
}
