#include "app/program.hpp"

int main(int argc, char** argv) { return karcher::app::program(argc, argv); }
