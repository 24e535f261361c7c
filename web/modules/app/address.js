// The address of what is looked at: #view/part?key=value. Reload and back show the same again.

// never throws: what cannot be decoded stays as it is
export function parse(hash) {
  const [path, search = ""] = hash.replace(/^#/, "").split("?");
  const [view, ...rest] = path.split("/").map(decoded);
  return { view, rest: rest.filter((part) => part !== ""), query: Object.fromEntries(new URLSearchParams(search)) };
}

export function written({ view, rest = [], query = {} }) {
  const pairs = Object.entries(query).filter(([, value]) => value !== "" && value !== null && value !== undefined && value !== false);
  const path = [view, ...rest].map(encodeURIComponent).join("/").replaceAll("%2C", ",");
  return `#${path}${pairs.length ? `?${new URLSearchParams(pairs)}` : ""}`;
}

export function here() {
  return parse(location.hash);
}

// says where one is now; `step`: back leads to where one was before. The view is not drawn again
export function note(address, { step = false } = {}) {
  const hash = written(address);
  if (hash === location.hash) return;
  if (step) history.pushState(null, "", hash);
  else history.replaceState(null, "", hash);
}

function decoded(part) {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}
