# What `cmake --install` and `cpack` put where: public headers, libraries, the CMake package `percale`, percale.pc, the program, data.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(percale_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/percale)

# One export a component, so that a program that only wants percale::engine needs neither FCL nor Bullet. Order: what is needed first.
set(percale_components "")
foreach(component engine collision brute_force fcl bullet c c_shared)
  if(TARGET percale_${component})
    list(APPEND percale_components ${component})
    install(TARGETS percale_${component} EXPORT percale_${component}
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(EXPORT percale_${component} NAMESPACE percale:: DESTINATION ${percale_package_dir} FILE percale-${component}.cmake)
  endif()
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/include/ DESTINATION include)
if(TARGET percale_collision)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/collision/include/ DESTINATION include)
endif()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/percale_config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/percaleConfig.cmake
  INSTALL_DESTINATION ${percale_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/percaleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/percaleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/percaleConfigVersion.cmake
  DESTINATION ${percale_package_dir})

# percale.pc: the engine and, where built, contact on FCL's trees. FCL's own .pc file would force C++11 on its users, and Percale's
# public headers do not need it, so its libraries are named instead.
set(percale_pc_libs "-lpercale_engine")
if(TARGET percale_fcl)
  set(percale_pc_libs "-lpercale_fcl -lpercale_collision -lpercale_engine -lfcl -lccd")
endif()
file(RELATIVE_PATH percale_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${CMAKE_CURRENT_LIST_DIR}/percale.pc.in ${CMAKE_CURRENT_BINARY_DIR}/percale.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/percale.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
# percale-c.pc: libpercale.so, which needs no other name on the command line.
if(TARGET percale_c_shared)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/percale_c.pc.in ${CMAKE_CURRENT_BINARY_DIR}/percale-c.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/percale-c.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()

if(TARGET percale)
  set_target_properties(percale PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS percale RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  if(BUILD_SHARED_LIBS)
    install(TARGETS percale_scenes LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
endif()
foreach(folder scenes meshes examples)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/percale OPTIONAL)
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME percale)
set(CPACK_PACKAGE_CONTACT "Percale contributors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
if(TARGET percale_collision)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libccd-dev")
endif()
if(TARGET percale_fcl)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libfcl-dev")
endif()
if(TARGET percale_bullet)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libbullet-dev")
endif()
include(CPack)
