#include <string_view>

#include "karcher/io/page.hpp"

// The assembler copies the committed page into the program (KARCHER_PAGE_TEMPLATE is its path, from CMake), so nothing has to be installed beside it.
__asm__(
    ".pushsection .rodata\n"
    ".global karcher_page_template\n"
    "karcher_page_template:\n"
    ".incbin \"" KARCHER_PAGE_TEMPLATE
    "\"\n"
    ".global karcher_page_template_end\n"
    "karcher_page_template_end:\n"
    ".byte 0\n"
    ".popsection\n");

extern "C" {
extern const char karcher_page_template[];
extern const char karcher_page_template_end[];
}

namespace karcher {

std::string_view page_template() { return {karcher_page_template, static_cast<std::size_t>(karcher_page_template_end - karcher_page_template)}; }

}  // namespace karcher
