// What plots of many values need to know of them. No page elements here.
import { quantile } from "d3";
import { isNumber } from "./format.js";

// The magnitude that the given share of the values stays below; 0 without values.
export const magnitudeQuantile = (values, share) =>
  quantile(values.filter(isNumber).map(Math.abs), share) ?? 0;

// Every n-th element, so that no more than `limit` are left.
export function thinned(values, limit) {
  const step = Math.ceil(values.length / limit);
  return step <= 1 ? values : values.filter((_, index) => index % step === 0);
}
