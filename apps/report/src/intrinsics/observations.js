// The corners of the data as flat lists, what became of each, and what several sections ask of the whole. No page
// elements here.
import { median } from "d3";
import { isNumber } from "../shared/format.js";

// What became of a corner that came to the estimate.
export const FATE = { whole: "whole", weighedDown: "weighed-down", outlier: "outlier", unused: "unused" };

export const viewsOf = (data) => data.views ?? [];
export const usedViews = (data) => viewsOf(data).filter((view) => !view.left_out);

export function namedCorner([x, y, dx, dy, weight]) {
  return { x, y, dx, dy, weight, fate: fateOf(dx, dy, weight) };
}

function fateOf(dx, dy, weight) {
  if (!isNumber(dx) || !isNumber(dy) || !isNumber(weight)) return FATE.unused;
  if (weight <= 0) return FATE.outlier;
  return weight < 1 ? FATE.weighedDown : FATE.whole;
}

export const cornersOf = (view) => (view.corners ?? []).map(namedCorner);

// Of all views that took part: every corner with a residual, with the name of its view.
export const usedCorners = (data) =>
  usedViews(data).flatMap((view) =>
    cornersOf(view)
      .filter(({ fate }) => fate !== FATE.unused)
      .map((corner) => ({ ...corner, view: view.name })),
  );

export const lengthOf = ({ dx, dy }) => Math.hypot(dx, dy);
export const countOf = (corners, fate) => corners.filter((corner) => corner.fate === fate).length;

// {width, height} of the camera's image: the camera's, or a view's, or what the corners take up.
export function imageSize(data) {
  const { width_px: width, height_px: height } = data.intrinsics?.camera ?? {};
  if (width > 0 && height > 0) return { width, height };
  const sized = viewsOf(data).find((view) => view.width > 0 && view.height > 0);
  return sized ? { width: sized.width, height: sized.height } : extentOf(viewsOf(data));
}

export function extentOf(views) {
  let [width, height] = [640, 480];
  for (const view of views)
    for (const [x, y] of view.corners ?? [])
      [width, height] = [Math.max(width, x + 1), Math.max(height, y + 1)];
  return { width: Math.ceil(width), height: Math.ceil(height) };
}

// How far away the board was: the middle one of the views' distances; null where none is known.
export const boardDistance = (data) =>
  median(
    usedViews(data)
      .map(({ distance_m: distance }) => distance)
      .filter(isNumber),
  ) ?? null;

// Which of several distances (null: infinitely far) is nearest to the board's, by ratio; 0 where that is not known.
export function nearestToBoard(distances, board) {
  if (!isNumber(board)) return 0;
  const away = (distance) => (isNumber(distance) ? Math.abs(Math.log(distance / board)) : Infinity);
  return distances.reduce(
    (best, distance, index) => (away(distance) < away(distances[best]) ? index : best),
    0,
  );
}

// Cells of equal size over an image: the middle of each, row by row.
export const cellMiddles = ({ columns, rows }, { width, height }) =>
  Array.from({ length: columns * rows }, (_, cell) => ({
    x: (((cell % columns) + 0.5) * width) / columns - 0.5,
    y: ((Math.floor(cell / columns) + 0.5) * height) / rows - 0.5,
  }));
