// The measurements of the data as flat lists, and the statistics that several sections share.
import { isNumber } from "../shared/format.js";
import { magnitudeQuantile } from "../shared/statistics.js";

// Weight below which a sample counts as an outlier; the estimator's weights fall from 1 at 3 sigma to 0 at 6.
export const OUTLIER_WEIGHT = 0.5;
const SAMPLES_PER_BIN = 15;

export const imagesOf = (data) => data.images ?? [];
export const usedImages = (data) => imagesOf(data).filter((image) => !image.left_out);
export const edgesOf = (image) => image.edges ?? [];

export const namedSample = ([x, y, residual, weight, place]) => ({ x, y, residual, weight, place });
export const isOutlier = (sample) => isNumber(sample.weight) && sample.weight < OUTLIER_WEIGHT;

// Edges that took part, each with the name of its image and its samples by name.
export function usedEdges(data) {
  return usedImages(data).flatMap((image) =>
    edgesOf(image)
      .filter((edge) => !edge.left_out)
      .map((edge) => ({ ...edge, image: image.name, samples: (edge.samples ?? []).map(namedSample) })),
  );
}

// Every sample of those edges with a residual: [{image, leg, edge, x, y, residual, weight, place}].
export function usedSamples(edges) {
  return edges.flatMap(({ image, leg, edge, samples }) =>
    samples.filter((sample) => isNumber(sample.residual)).map((sample) => ({ image, leg, edge, ...sample })),
  );
}

// Edges left out of images that took part: [{image, leg, edge, reason}].
export function leftOutEdges(data) {
  return usedImages(data).flatMap((image) =>
    edgesOf(image)
      .filter((edge) => edge.left_out)
      .map((edge) => ({ image: image.name, leg: edge.leg, edge: edge.edge, reason: edge.left_out })),
  );
}

// A range (px) that shows all samples but outliers, with some room.
export function residualLimit(samples) {
  const inliers = samples.filter((sample) => !isOutlier(sample)).map(({ residual }) => residual);
  return Math.max(1.3 * magnitudeQuantile(inliers, 0.995), 1e-3);
}

// Weighted means of `residual` in equal bins of `place` in [0, 1]: [{place, mean}], without empty bins.
export function meanAlong(
  samples,
  bins = Math.min(20, Math.max(4, Math.round(samples.length / SAMPLES_PER_BIN))),
) {
  const sums = Array.from({ length: bins }, () => ({ weight: 0, residual: 0 }));
  for (const { place, residual, weight } of samples) {
    if (!isNumber(place) || !isNumber(residual)) continue;
    const bin = sums[Math.min(bins - 1, Math.max(0, Math.floor(place * bins)))];
    bin.weight += weight ?? 1;
    bin.residual += (weight ?? 1) * residual;
  }
  return sums
    .map(({ weight, residual }, index) => ({ place: (index + 0.5) / bins, weight, mean: residual / weight }))
    .filter(({ weight }) => weight > 0);
}
