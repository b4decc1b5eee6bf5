// Linked into every program that the address sanitizer watches (KARCHER_SANITIZE): what MPI and PETSc leave behind themselves is not looked at.

#include <dlfcn.h>

extern "C" {

// MPI loads its parts as plugins and unloads them at the end, before leaks are looked for; what they leave would come from unknown modules. So they stay.
int dlclose(void*) noexcept { return 0; }

// None of this memory is ours, and none grows with a run. The last has no caller on the short stacks of libraries that are built without frame pointers;
// Karcher itself never calls it.
const char* __lsan_default_suppressions() {
  return "leak:libmpi\nleak:libopen-rte\nleak:libopen-pal\nleak:libpmix\nleak:mca_\nleak:libhwloc\nleak:libevent\nleak:libpetsc\n"
         "leak:__vasprintf_internal\n";
}

const char* __lsan_default_options() { return "print_suppressions=0"; }
const char* __ubsan_default_options() { return "print_stacktrace=1"; }

// What the rooms that read files tell the fuzzers (tests/fuzz), whose engine has its own; no other program listens.
__attribute__((weak)) void __sanitizer_cov_trace_pc() {}
__attribute__((weak)) void __sanitizer_cov_trace_cmpf(float, float) {}
__attribute__((weak)) void __sanitizer_cov_trace_cmpd(double, double) {}

}  // extern "C"
