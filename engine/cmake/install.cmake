# What `cmake --install` puts where, in the components of which packages.cmake makes packages: `program` (with scenes and what they
# read), `library` (what programs load), `development` (headers, libraries, the CMake package, .pc files, examples), `python`.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(percale_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/percale)
set(percale_data_dir ${CMAKE_INSTALL_DATADIR}/percale)

# One export a component, so that a program that only wants percale::engine needs neither FCL nor Bullet. Order: what is needed first.
set(percale_components "")
foreach(component engine collision brute_force fcl bullet c c_shared)
  if(TARGET percale_${component})
    list(APPEND percale_components ${component})
    install(TARGETS percale_${component} EXPORT percale_${component}
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
    install(EXPORT percale_${component} NAMESPACE percale:: DESTINATION ${percale_package_dir} FILE percale-${component}.cmake
      COMPONENT development)
  endif()
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/include/ DESTINATION include COMPONENT development)
if(TARGET percale_collision)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/collision/include/ DESTINATION include COMPONENT development)
endif()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/percale_config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/percaleConfig.cmake
  INSTALL_DESTINATION ${percale_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/percaleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/percaleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/percaleConfigVersion.cmake
  DESTINATION ${percale_package_dir} COMPONENT development)
if(TARGET percale)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/percale_scene_tests.cmake DESTINATION ${percale_package_dir} COMPONENT development)
endif()

# percale.pc: the engine and, where built, contact on FCL's trees. FCL's own .pc file would force C++11 on its users, and Percale's
# public headers do not need it, so its libraries are named instead.
set(percale_pc_libs "-lpercale_engine")
if(TARGET percale_fcl)
  set(percale_pc_libs "-lpercale_fcl -lpercale_collision -lpercale_engine -lfcl -lccd")
endif()
file(RELATIVE_PATH percale_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${CMAKE_CURRENT_LIST_DIR}/percale.pc.in ${CMAKE_CURRENT_BINARY_DIR}/percale.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/percale.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
# percale-c.pc: libpercale.so, which needs no other name on the command line.
if(TARGET percale_c_shared)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/percale_c.pc.in ${CMAKE_CURRENT_BINARY_DIR}/percale-c.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/percale-c.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endif()

if(TARGET percale)
  install(TARGETS percale RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  if(BUILD_SHARED_LIBS)
    file(RELATIVE_PATH percale_bin_to_lib /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
    set_target_properties(percale PROPERTIES INSTALL_RPATH "$ORIGIN/${percale_bin_to_lib}")
    install(TARGETS percale_scenes LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_SKIP)
  endif()
  foreach(folder scenes meshes patterns)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/${folder} DESTINATION ${percale_data_dir} COMPONENT program)
  endforeach()
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/examples DESTINATION ${percale_data_dir} COMPONENT development
  PATTERN *.py EXCLUDE PATTERN __pycache__ EXCLUDE)
# The licence, in each component. CMAKE_INSTALL_DOCDIR may be named after a host project. No file may be in two packages: where packages
# are made, packages.cmake gives each the licence in a folder of its own.
set(percale_licensed program library development python)
if(PROJECT_IS_TOP_LEVEL AND NOT BUILD_SHARED_LIBS AND CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND TARGET percale AND TARGET percale_c_shared)
  set(percale_makes_packages ON)
  set(percale_licensed program)
endif()
foreach(component ${percale_licensed})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/debian/copyright DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/percale COMPONENT ${component})
endforeach()

# The Python module. Where Python looks goes by the prefix, which may be given as late as to `cmake --install`.
if(TARGET percale_python)
  get_target_property(percale_python_program percale_python PERCALE_PYTHON_PROGRAM)
  execute_process(COMMAND ${percale_python_program} ${CMAKE_CURRENT_LIST_DIR}/python_folders.py
    OUTPUT_VARIABLE percale_python_folders OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  list(POP_FRONT percale_python_folders percale_python_system percale_python_local percale_python_other percale_python_minor)
  install(CODE "
    set(percale_python_dir \"${percale_python_other}\")
    if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
      set(percale_python_dir \"${percale_python_system}\")
    elseif(CMAKE_INSTALL_PREFIX STREQUAL \"/usr/local\")
      set(percale_python_dir \"${percale_python_local}\")
    endif()" COMPONENT python)
  if(BUILD_SHARED_LIBS)
    foreach(folder ${percale_python_system} ${percale_python_local} ${percale_python_other})
      file(RELATIVE_PATH percale_python_to_lib /${folder}/percale /${CMAKE_INSTALL_LIBDIR})
      list(APPEND percale_python_rpath "$ORIGIN/${percale_python_to_lib}")
    endforeach()
    list(REMOVE_DUPLICATES percale_python_rpath)
    set_target_properties(percale_python PROPERTIES INSTALL_RPATH "${percale_python_rpath}")
  endif()
  # The destinations are read when that code has run.
  install(TARGETS percale_python LIBRARY DESTINATION "\${percale_python_dir}/percale" COMPONENT python)
  get_target_property(python_files percale_python PERCALE_PACKAGE_FILES)
  install(FILES ${python_files} DESTINATION "\${percale_python_dir}/percale" COMPONENT python)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/examples DESTINATION ${percale_data_dir} COMPONENT python
    FILES_MATCHING PATTERN *.py PATTERN __pycache__ EXCLUDE)
endif()
