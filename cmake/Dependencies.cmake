# What the library links. Included by this project and, installed, by KarcherConfig.cmake, so that both find the same things under the same target names.
find_package(PkgConfig REQUIRED)
pkg_check_modules(PETSC REQUIRED QUIET IMPORTED_TARGET PETSc)
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(fmt REQUIRED)
find_package(ZLIB REQUIRED)
find_package(nlohmann_json REQUIRED)
