// The name of a model in the ladder: its number, and what it was changed by.

export function rungName(rung) {
  const change = [...[rung.added ?? []].flat().map((name) => `+ ${name}`), ...[rung.removed ?? []].flat().map((name) => `− ${name}`)];
  return `${rung.model_id}: ${change.join(", ").replaceAll("_", " ") || "base"}`;
}
