#include "app/signals.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "karcher/solve/minimize.hpp"

namespace karcher::app {
namespace {

extern "C" void on_interrupt(int) {
  if (interrupt_requested.exchange(true)) _exit(130);
  static constexpr char text[] = "\nInterrupted: the current iteration is finished first; once more ends at once.\n";
  if (isatty(STDERR_FILENO) && write(STDERR_FILENO, text, sizeof text - 1) < 0) return;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;  // nohup
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace karcher::app
