// One colour a leg, in all plots; legs 0-based.
export const legColor = (leg) => `var(--leg-${(leg % 6) + 1})`;
