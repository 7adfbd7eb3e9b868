// Things left out, by reason. No page elements here.

// Reasons that differ only in their numbers belong together; their numbers are then shown as "…".
export function groupedByReason(things) {
  const groups = new Map();
  for (const thing of things) {
    const pattern = thing.reason.replace(/[-+]?\d+(\.\d+)?/g, "…");
    if (!groups.has(pattern)) groups.set(pattern, []);
    groups.get(pattern).push(thing);
  }
  return [...groups]
    .map(([pattern, members]) => {
      const same = members.every(({ reason }) => reason === members[0].reason);
      return { reason: same ? members[0].reason : pattern, members };
    })
    .sort((a, b) => b.members.length - a.members.length);
}
