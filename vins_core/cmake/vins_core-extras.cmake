# What every package of the workspace compiles with. Comes to a package by
# find_package(catkin COMPONENTS vins_core); vins_core itself includes this file directly.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()
# Debian's pluginlib, behind rosbag, looks for Python 3 by itself; only catkin's sees ROS's modules.
# Packages therefore name vins_core first among their catkin components.
if(NOT Python3_EXECUTABLE AND PYTHON_EXECUTABLE)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
endif()
option(VINS_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
option(VINS_SANITIZE "Compile with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
# Optimized, because Eigen unoptimized is too slow to test; a finding ends the program.
set(vins_sanitize_flags -fsanitize=address,undefined -fno-sanitize-recover=all
  -fno-omit-frame-pointer -O2 -g1)

# vins_target_options(TARGET ...): C++17, the warnings, and floating point that does not depend on
# whether the machine has fused multiply-add. Nothing reads errno or the processor's exception flags
# after mathematics: without them the compiler computes several roots at once, with the same values.
function(vins_target_options)
  foreach(target ${ARGN})
    set_target_properties(${target} PROPERTIES
      CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -ffp-contract=off
      -fno-math-errno -fno-trapping-math
      $<$<BOOL:${VINS_WARNINGS_AS_ERRORS}>:-Werror>)
    if(VINS_SANITIZE)
      target_compile_options(${target} PRIVATE ${vins_sanitize_flags})
      target_link_options(${target} PRIVATE -fsanitize=address,undefined)
    endif()
  endforeach()
endfunction()

# vins_add_gtests(LIBRARY NAME ...): one executable test/NAME.cpp each, linked to LIBRARY.
function(vins_add_gtests library)
  foreach(name ${ARGN})
    catkin_add_gtest(${library}_${name} test/${name}.cpp WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    if(TARGET ${library}_${name})
      target_link_libraries(${library}_${name} ${library} gtest_main)
      vins_target_options(${library}_${name})
    endif()
  endforeach()
endfunction()
