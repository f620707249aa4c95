# Debian packages by `cmake --preset packages && cmake --build --preset packages`: percale, libpercaleX.Y, libpercale-dev and, with
# PERCALE_PYTHON, python3-percale. The shared library has a package of its own, named after its SONAME, as Debian wants it: a program that
# loads it then needs neither the program percale nor what that links, and two versions may be installed beside each other.
if(NOT percale_makes_packages)
  # Under another prefix libraries would lie beside Debian's own folders.
  file(WRITE ${PROJECT_BINARY_DIR}/CPackConfig.cmake "message(FATAL_ERROR \"packages hold the program and static libraries under /usr: "
    "cmake --preset packages && cmake --build --preset packages\")\n")
  return()
endif()

set(percale_soname_version ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME percale)
# Who hands packages on gives a name with an address: -DCPACK_PACKAGE_CONTACT="Name <address>". The project itself has no address.
if(NOT CPACK_PACKAGE_CONTACT)
  set(CPACK_PACKAGE_CONTACT "Percale contributors")
endif()
set(percale_deb_contact "${CPACK_PACKAGE_CONTACT}")
if(NOT percale_deb_contact MATCHES "<")
  string(APPEND percale_deb_contact " <>")  # the changelog's last line is one by its brackets
endif()
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # CPack would put the project's description before that of each package
set(percale_deb_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
string(TIMESTAMP percale_deb_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${PROJECT_BINARY_DIR}/debian/changelog @ONLY)
find_program(GZIP_PROGRAM gzip REQUIRED)

# percale_package(COMPONENT NAME SECTION DEPENDS DESCRIPTION): a package of what has been installed as that component. The description's
# first line stands in lists of packages.
function(percale_package component name section depends description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}" PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  # What Debian wants in each package and `cmake --install` does not bring.
  set(folder share/doc/${name})
  install(FILES ${PROJECT_SOURCE_DIR}/engine/cmake/debian/copyright DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}\")
    execute_process(COMMAND \"${GZIP_PROGRAM}\" -9nc \"${PROJECT_BINARY_DIR}/debian/changelog\"
      OUTPUT_FILE \"\${folder}/changelog.Debian.gz\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"${GZIP_PROGRAM}\" -9nc \"${PROJECT_SOURCE_DIR}/.github/CHANGELOG.md\"
      OUTPUT_FILE \"\${folder}/changelog.gz\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component} EXCLUDE_FROM_ALL)
endfunction()

set(CPACK_COMPONENTS_ALL "")
percale_package(program percale science ""
"cloth that drapes over meshes and never goes through them
Percale simulates cloth as masses and springs, by implicit steps, over mesh
obstacles, rigid or bending. Every run carries a certificate: an exact test of
every frame that shares no code with the contact search.
.
This package holds the program percale, which runs, checks, compares and draws
scene files, and example scenes in /usr/share/percale/scenes.")
percale_package(library libpercale${percale_soname_version} libs ""
"cloth that drapes over meshes - C library
Percale simulates cloth as masses and springs, by implicit steps, over mesh
obstacles, rigid or bending.
.
This package holds the shared library with the C interface.")
# Programs that link it depend on a package whose library has that SONAME and is not older.
file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs "libpercale ${percale_soname_version} libpercale${percale_soname_version} (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/shlibs ${CMAKE_CURRENT_LIST_DIR}/debian/triggers)
set(percale_dev_depends "libpercale${percale_soname_version} (= ${percale_deb_version}), libeigen3-dev (>= 3.4), libccd-dev, libfcl-dev, libbullet-dev")
percale_package(development libpercale-dev libdevel "${percale_dev_depends}"
"cloth that drapes over meshes - development files
Percale simulates cloth as masses and springs, by implicit steps, over mesh
obstacles, rigid or bending.
.
This package holds the headers of the C++ and the C interface, the static
libraries, the CMake package, files for pkg-config and examples in
/usr/share/percale/examples. With the package percale, CMake projects may run
scene files as tests.")
# percale_scene_tests.cmake runs the program.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "percale (= ${percale_deb_version})")
if(TARGET percale_python)
  math(EXPR percale_next_python "${percale_python_minor} + 1")
  percale_package(python python3-percale python
    "python3 (>= 3.${percale_python_minor}), python3 (<< 3.${percale_next_python}), python3-numpy"
"cloth that drapes over meshes - Python module
Percale simulates cloth as masses and springs, by implicit steps, over mesh
obstacles, rigid or bending.
.
This package holds the Python module percale: simulations made by calls, scene
files, the certificate; and examples in /usr/share/percale/examples.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/postinst ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
endif()
include(CPack)
