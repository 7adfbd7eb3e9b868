#include "apps/interruption.h"

#include <array>
#include <csignal>

namespace legible {
namespace {

volatile std::sig_atomic_t has_come = 0;

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
using Handler = void (*)(int);
std::array<Handler, kSignals.size()> handlers_before;

void Note(int) { has_come = 1; }

}  // namespace

Interruption::Interruption() {
  has_come = 0;
  for (size_t i = 0; i < kSignals.size(); ++i) handlers_before[i] = std::signal(kSignals[i], Note);
}

Interruption::~Interruption() {
  for (size_t i = 0; i < kSignals.size(); ++i) std::signal(kSignals[i], handlers_before[i]);
}

bool Interruption::HasCome() const { return has_come != 0; }

}  // namespace legible
