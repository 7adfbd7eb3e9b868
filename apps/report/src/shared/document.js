// The document that a command prints, by paths into it such as "camera.sigma.fx". No page elements here.

export const valueAt = (document, path) => path.split(".").reduce((part, name) => part?.[name], document);

// [[path, value]] of all members that hold no others; a list is one, unless `intoLists`.
export function leavesOf(value, { intoLists = false, path = "" } = {}) {
  const isBranch = value && typeof value === "object" && (intoLists || !Array.isArray(value));
  if (!isBranch) return [[path, value]];
  return Object.entries(value).flatMap(([name, part]) =>
    leavesOf(part, { intoLists, path: path ? `${path}.${name}` : name }),
  );
}
