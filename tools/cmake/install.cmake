# What a host needs of the engine: the headers, the libraries, find_package(Pellicle) and pkg-config.
# Components are those of the Debian packages.
include(CMakePackageConfigHelpers)

set(cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Pellicle)
install(FILES engine/pellicle.h engine/pellicle.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT libpellicle-dev)

foreach(kind IN ITEMS shared static)
  if(TARGET pellicle_${kind})
    install(TARGETS pellicle_${kind} EXPORT pellicle_${kind}_export
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT libpellicle0 NAMELINK_COMPONENT libpellicle-dev
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libpellicle-dev)
    install(EXPORT pellicle_${kind}_export FILE Pellicle-${kind}.cmake NAMESPACE Pellicle::
      DESTINATION ${cmake_dir} COMPONENT libpellicle-dev)
  endif()
endforeach()

configure_package_config_file(tools/cmake/PellicleConfig.cmake.in
  ${CMAKE_BINARY_DIR}/PellicleConfig.cmake INSTALL_DESTINATION ${cmake_dir}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/PellicleConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/PellicleConfig.cmake ${CMAKE_BINARY_DIR}/PellicleConfigVersion.cmake
  DESTINATION ${cmake_dir} COMPONENT libpellicle-dev)

# The prefix is found from where the file lies, so that an installed tree can be moved.
file(RELATIVE_PATH prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix_from_pc "${prefix_from_pc}")
# What the static library needs, which pkg-config --static tells, or always where it is alone. As
# libraries: packages of pkg-config would have to be there for hosts of the shared library, too.
set(pc_libs_private "-lhwy -lstdc++ -lm -lpthread -ldl")
if(PELLICLE_TBB)
  string(PREPEND pc_libs_private "-ltbb ")
endif()
if(NOT TARGET pellicle_shared)
  set(pc_libs " ${pc_libs_private}")
  set(pc_libs_private "")
endif()
configure_file(tools/cmake/pellicle.pc.in ${CMAKE_BINARY_DIR}/pellicle.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/pellicle.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT libpellicle-dev)

if(TARGET pellicle_command)
  file(RELATIVE_PATH lib_from_bin /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(pellicle_command PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
  install(TARGETS pellicle_command DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT pellicle)
  # The manual page is made by the command itself, of its options.
  add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/pellicle.1
    COMMAND pellicle_command --man > ${CMAKE_BINARY_DIR}/pellicle.1
    DEPENDS pellicle_command)
  add_custom_target(pellicle_manual ALL DEPENDS ${CMAKE_BINARY_DIR}/pellicle.1)
  install(FILES ${CMAKE_BINARY_DIR}/pellicle.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
    COMPONENT pellicle)
  install(FILES tools/cmake/pellicle.bash
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME pellicle
    COMPONENT pellicle)
  install(FILES tools/cohort/Snakefile DESTINATION ${CMAKE_INSTALL_DATADIR}/pellicle
    COMPONENT pellicle)
  # Slicer starts a program, without a subcommand, and asks it for --xml.
  set(slicer_dir ${CMAKE_INSTALL_LIBDIR}/pellicle/cli-modules)
  file(RELATIVE_PATH bin_from_slicer /${slicer_dir} /${CMAKE_INSTALL_BINDIR})
  foreach(module PellicleExtract PellicleLabels)
    configure_file(tools/cmake/${module}.in ${CMAKE_BINARY_DIR}/${module} @ONLY)
    install(PROGRAMS ${CMAKE_BINARY_DIR}/${module} DESTINATION ${slicer_dir} COMPONENT pellicle)
  endforeach()
endif()
