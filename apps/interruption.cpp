#include "apps/interruption.h"

#include <csignal>

namespace legible {
namespace {

volatile std::sig_atomic_t has_come = 0;
using Handler = void (*)(int);
Handler on_interrupt = SIG_DFL, on_terminate = SIG_DFL;

void Note(int) { has_come = 1; }

}  // namespace

Interruption::Interruption() {
  has_come = 0;
  on_interrupt = std::signal(SIGINT, Note);
  on_terminate = std::signal(SIGTERM, Note);
}

Interruption::~Interruption() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_terminate);
}

bool Interruption::HasCome() const { return has_come != 0; }

}  // namespace legible
