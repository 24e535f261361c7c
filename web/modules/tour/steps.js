// What the guided tour does, in order: each step is done on the real page, and is over when the page shows that it was.

const onBench = "#bench?kind=steps&repeats=3";
const ofTrials = (address) => /^#study\/\d+/.test(address);

// words; target: what is to be pressed, the first of these selectors that is there; sight: what is to be seen, where that
// is something else; at: where it is, to be led there;
// done({address, status, token, seen(selector)}): it has been done
export const STEPS = [
  { words: "Paste the token that 'friction-bench serve' printed. Reading needs none; whatever moves or changes something does.",
    at: onBench, target: ["#token-input"], done: ({ token }) => token },
  { words: "Press Start. Above it stands what will move, how far and for how long; nothing else on the page moves the joint.",
    at: onBench, target: [".start button.primary"], done: ({ status }) => status?.state === "running" },
  { words: "The joint moves: arm, load and current as they are measured. Press STOP, or Esc, at any time.",
    at: onBench, target: ["#stop"], sight: ".live-now", done: ({ status }) => status?.state === "idle" && Boolean(status.run) },
  { words: "Now a joint that hides something. Press New challenge: one is drawn at random and recorded, in some seconds.",
    at: "#learn/challenge", target: [".challenge button.primary"], done: ({ seen }) => seen(".challenge .good") },
  { words: "Press Study it: its recordings are compared with a model.",
    at: "#learn/challenge", target: ["a[href^='#study/new/']"], done: ({ address }) => address.startsWith("#study/new/") || ofTrials(address) },
  { words: "The page says whether these trials can carry a model. Press Create study: the first model is fitted.",
    target: ["#study-create"], done: ({ address }) => ofTrials(address) },
  { words: "On top stands by how much the model is off. The map shows at which speed and load; press a dark cell to see when that was.",
    target: ["table.heat button.worst"], done: ({ seen }) => seen("[aria-label='Moments']") },
  { words: "Which effect does the model lack? Choose 3 Diagnose, then press Diagnose: every effect of the catalogue is tested.",
    target: ["#diagnose-now", "a[data-step='diagnose']"], done: ({ seen }) => seen(".diagnosed .sentence") },
  { words: "The curve of the candidate lies over what the model leaves. Press Add. Where nothing is missing, press Next.",
    target: [".diagnosed article button.add"], done: ({ seen }) => seen(".study-change .bars") },
  { words: "The error before and after, on trials that the model was not fitted to; Undo takes it back. Choose 5 Result: the error from model to model, the parameters, the report.",
    target: ["a[data-step='result']"], done: ({ address }) => address.includes("/result") },
  { words: "Was that it? Press Guess and reveal, then Reveal: you are told what was hidden, and what of the guess was right.",
    at: "#learn/challenge", target: [".guess button.primary", "button.reveal"], done: ({ seen }) => seen(".revealed") },
  { words: "That was all of it: record, compare, diagnose, add, judge. Bring recordings of your own under Trials, or plan many experiments under Queue.",
    target: [], done: () => false },
];

// the step after one that is over; the same where it is not. Pure
export function following(step, seen) {
  return step < STEPS.length - 1 && STEPS[step].done(seen) ? step + 1 : step;
}
