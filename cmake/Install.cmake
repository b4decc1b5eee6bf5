# `cmake --install build --prefix DIR`: the program, the library's headers (testing/ included) and a package for find_package(Karcher).
include(CMakePackageConfigHelpers)

set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/Karcher)
# The rooms of the library; app is the program's alone.
set(rooms options math expression manifold interpolation energy mesh field assembly catalogue solve io problem)
foreach(room ${rooms})
  set_target_properties(karcher_${room} PROPERTIES EXPORT_NAME ${room})
endforeach()
list(TRANSFORM rooms PREPEND karcher_ OUTPUT_VARIABLE room_targets)
install(TARGETS karcher ${room_targets} EXPORT KarcherTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT KarcherTargets NAMESPACE karcher:: DESTINATION ${package_directory})
install(DIRECTORY include/karcher ${PROJECT_BINARY_DIR}/include/karcher DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)

configure_package_config_file(cmake/KarcherConfig.cmake.in ${PROJECT_BINARY_DIR}/KarcherConfig.cmake INSTALL_DESTINATION ${package_directory})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/KarcherConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/KarcherConfig.cmake ${PROJECT_BINARY_DIR}/KarcherConfigVersion.cmake cmake/Dependencies.cmake
        DESTINATION ${package_directory})
# `karcher list examples` and `karcher new` look for them beside the program.
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/karcher PATTERN results* EXCLUDE)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
