#include "karcher/solve/together.hpp"

#include "karcher/solve/collectives.hpp"

namespace karcher {

void throw_everywhere(const std::string& error) {
  const std::string first = first_text(error);
  if (first.empty()) return;
  if (first[0] == 'I') throw SharedInputError(first.substr(1));
  throw SharedError(first.substr(1));
}

}  // namespace karcher
