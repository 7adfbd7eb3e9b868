#include "core/rig/sensor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace legible {
namespace {

constexpr int kRowsPerTask = 16;

// A Gaussian sampled at the pixels: weights from the middle outwards, of which all but the first count twice
// and the sum is 1.
std::vector<double> SampledGaussian(double width_px, int reach) {
  std::vector<double> weights(static_cast<size_t>(reach) + 1);
  double sum = 0;
  for (int i = 0; i <= reach; ++i) {
    const double weight = std::exp(-0.5 * i * i / (width_px * width_px));
    weights[static_cast<size_t>(i)] = weight;
    sum += i == 0 ? weight : 2 * weight;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

double Variance(const std::vector<double>& weights) {
  double variance = 0;
  for (size_t i = 1; i < weights.size(); ++i) variance += 2 * weights[i] * static_cast<double>(i * i);
  return variance;
}

// Of the sampled Gaussians the one of standard deviation sigma_px > 0: narrow ones lose some by the sampling.
std::vector<float> GaussianWeights(double sigma_px) {
  const int reach = static_cast<int>(std::ceil(4 * sigma_px));
  double low_px = 0.9 * sigma_px, high_px = sigma_px + 0.5;
  for (int i = 0; i < 40; ++i) {
    const double middle_px = 0.5 * (low_px + high_px);
    (Variance(SampledGaussian(middle_px, reach)) < sigma_px * sigma_px ? low_px : high_px) = middle_px;
  }
  const std::vector<double> weights = SampledGaussian(high_px, reach);
  return {weights.begin(), weights.end()};
}

template <typename RowJob>
void ForEachRow(int height, const RowJob& job) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, kRowsPerTask),
                    [&](const tbb::blocked_range<int>& rows) {
                      for (int y = rows.begin(); y < rows.end(); ++y) job(y);
                    });
}

// One row from those about it.
void BlurDown(const BrightnessImage& image, const std::vector<float>& weights, int y,
              std::vector<float>& sum) {
  const auto width = static_cast<size_t>(image.width);
  const float* const middle = image.Row(y);
  for (size_t x = 0; x < width; ++x) sum[x] = weights[0] * middle[x];
  for (size_t i = 1; i < weights.size(); ++i) {
    const float* const above = image.Row(std::max(0, y - static_cast<int>(i)));
    const float* const below = image.Row(std::min(image.height - 1, y + static_cast<int>(i)));
    for (size_t x = 0; x < width; ++x) sum[x] += weights[i] * (above[x] + below[x]);
  }
}

void BlurAcross(const std::vector<float>& padded, const std::vector<float>& weights, int width,
                float* result) {
  const float* const from = padded.data() + weights.size() - 1;
  for (int x = 0; x < width; ++x) result[x] = weights[0] * from[x];
  for (int i = 1; i < static_cast<int>(weights.size()); ++i) {
    const float weight = weights[static_cast<size_t>(i)];
    for (int x = 0; x < width; ++x) result[x] += weight * (from[x - i] + from[x + i]);
  }
}

// The standard normal distribution's quantile at a probability, by bisection.
double NormalQuantile(double probability) {
  double low = -10, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
  }
  return low;
}

}  // namespace

BrightnessImage Blurred(const BrightnessImage& image, double sigma_px) {
  if (!(sigma_px > 0)) return image;
  const std::vector<float> weights = GaussianWeights(sigma_px);
  const size_t width = static_cast<size_t>(image.width), reach = weights.size() - 1;
  BrightnessImage result{image.width, image.height, std::vector<float>(image.grey.size())};
  ForEachRow(image.height, [&](int y) {
    std::vector<float> sum(width), padded(width + 2 * reach);
    BlurDown(image, weights, y, sum);
    std::fill_n(padded.begin(), reach, sum.front());
    std::copy(sum.begin(), sum.end(), padded.begin() + static_cast<std::ptrdiff_t>(reach));
    std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(reach), reach, sum.back());
    BlurAcross(padded, weights, image.width, result.Row(y));
  });
  return result;
}

PixelNoise::PixelNoise(double sigma_grey, std::uint64_t seed) : quantiles_(), seed_(seed) {
  double squares = 0;
  for (size_t i = 0; i < kQuantiles; ++i) {
    const double quantile = NormalQuantile((static_cast<double>(i) + 0.5) / kQuantiles);
    quantiles_[i] = static_cast<float>(quantile);
    squares += quantile * quantile / kQuantiles;
  }
  const double scale = sigma_grey / std::sqrt(2 * squares);
  for (float& quantile : quantiles_) quantile *= static_cast<float>(scale);
}

GrayImage PixelNoise::Expose(const BrightnessImage& image, std::uint64_t frame) const {
  GrayImage exposed{image.width, image.height, std::vector<std::uint8_t>(image.grey.size())};
  const std::uint64_t stream = Scrambled(Scrambled(seed_) + frame);
  const auto width = static_cast<size_t>(image.width);
  ForEachRow(image.height, [&](int y) {
    const float* const grey = image.Row(y);
    const size_t start = static_cast<size_t>(y) * width;
    for (size_t x = 0; x < width; ++x) {
      const std::uint64_t bits = Scrambled(stream + start + x);
      const float noise = quantiles_[bits % kQuantiles] + quantiles_[(bits >> 32U) % kQuantiles];
      const float rounded = std::clamp(grey[x] + noise, 0.0F, 255.0F) + 0.5F;
      exposed.pixels[start + x] = static_cast<std::uint8_t>(rounded);
    }
  });
  return exposed;
}

}  // namespace legible
