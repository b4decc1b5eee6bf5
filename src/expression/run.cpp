// -ffp-contract=off (CMakeLists.txt)
#include "karcher/expression/run.hpp"

namespace karcher {

template void run<double>(const Instruction* first, const Instruction* last, double* r);

}  // namespace karcher
