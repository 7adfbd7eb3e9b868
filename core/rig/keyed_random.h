// Random numbers that depend on a seed, a purpose and a key alone: not on what was drawn before, nor how
// often.
#pragma once

#include <cstdint>
#include <limits>

namespace legible {

// What is drawn: separate streams of the same seed.
enum class RandomUse : std::uint64_t { kFrictionPhase = 1, kReadingNoise, kEdgeNoise };

// SplitMix64 (Steele, Lea and Flood 2014), started at a hash of seed, use and key; it costs nothing to start.
// A generator for the distributions of the standard library.
class KeyedRandom {
 public:
  using result_type = std::uint64_t;
  KeyedRandom(std::uint64_t seed, RandomUse use, std::uint64_t key)
      : state_(Mixed(Mixed(Mixed(seed) ^ static_cast<std::uint64_t>(use)) ^ key)) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return Mixed(state_ += kStep); }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;

  static std::uint64_t Mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace legible
