# The Debian packages libpellicle0.3, libpellicle-dev and pellicle; tools/package makes them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pellicle)
set(CPACK_PACKAGE_CONTACT "Pellicle developers <pellicle@localhost>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # the first line of each description
set(CPACK_COMPONENTS_ALL libpellicle0 libpellicle-dev pellicle)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Where dpkg-shlibdeps finds the library that the command needs; its package is named below.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/engine)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_STRIP_FILES ON)
set(about "A deformable mesh that changes its own topology extracts closed, oriented
surfaces without self-intersections from CT, MR and microscopy, coarse to
fine.

")
set(library_package libpellicle${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(same_version "${library_package} (= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_LIBPELLICLE0_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_LIBPELLICLE0_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBPELLICLE0_PACKAGE_RECOMMENDS libmimalloc2.0)
set(CPACK_DEBIAN_LIBPELLICLE0_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/tools/cmake/triggers)
set(CPACK_COMPONENT_LIBPELLICLE0_DESCRIPTION "closed triangulated surfaces from 3D images
${about}This package holds the shared library.")

set(CPACK_DEBIAN_LIBPELLICLE-DEV_PACKAGE_NAME libpellicle-dev)
set(CPACK_DEBIAN_LIBPELLICLE-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBPELLICLE-DEV_PACKAGE_DEPENDS "${same_version}")
# What a host that links the static library needs.
set(CPACK_DEBIAN_LIBPELLICLE-DEV_PACKAGE_SUGGESTS "libhwy-dev")
if(PELLICLE_TBB)
  string(PREPEND CPACK_DEBIAN_LIBPELLICLE-DEV_PACKAGE_SUGGESTS "libtbb-dev, ")
endif()
set(CPACK_COMPONENT_LIBPELLICLE-DEV_DESCRIPTION "closed triangulated surfaces from 3D images (development)
${about}This package holds the C header, the static library, and the files for
CMake's find_package(Pellicle) and for pkg-config.")

set(CPACK_DEBIAN_PELLICLE_PACKAGE_NAME pellicle)
set(CPACK_DEBIAN_PELLICLE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PELLICLE_PACKAGE_DEPENDS "${same_version}")
set(CPACK_COMPONENT_PELLICLE_DESCRIPTION "closed triangulated surfaces from 3D images (command)
${about}This package holds the command, and the command-line module
PellicleExtract for 3D Slicer.")
include(CPack)
