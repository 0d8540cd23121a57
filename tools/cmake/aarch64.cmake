# Builds for 64-bit ARM on another Debian machine, and runs what is built under qemu; tools/compilers
# uses it. GCC's cross compiler unless CMAKE_CXX_COMPILER is told to be Clang's.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(triple aarch64-linux-gnu)
set(CMAKE_LIBRARY_ARCHITECTURE ${triple})
if(NOT CMAKE_CXX_COMPILER)
  set(CMAKE_C_COMPILER ${triple}-gcc)
  set(CMAKE_CXX_COMPILER ${triple}-g++)
endif()
set(CMAKE_C_COMPILER_TARGET ${triple})
set(CMAKE_CXX_COMPILER_TARGET ${triple})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
