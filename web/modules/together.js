// A view shows itself when its first answers are there, all at once: nothing jumps while it fills.

const LONGEST_MS = 5000; // then what there is is shown; STOP, in the head of the page, waits for nothing

export function together(place, firstAnswers) {
  const timer = setTimeout(() => show(), LONGEST_MS);
  const show = () => {
    clearTimeout(timer);
    place.classList.remove("filling");
    place.removeAttribute("aria-busy");
  };
  place.classList.add("filling");
  place.setAttribute("aria-busy", "true");
  Promise.allSettled(firstAnswers).then(show);
}
