# Builds for 64-bit ARM on another Debian machine; tools/compilers uses it. By GCC's cross compiler, or by
# Clang where CMAKE_CXX_COMPILER says so.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(triple aarch64-linux-gnu)
set(CMAKE_LIBRARY_ARCHITECTURE ${triple})
if(CMAKE_CXX_COMPILER MATCHES "clang")
  set(CMAKE_C_COMPILER clang)
else()
  set(CMAKE_C_COMPILER ${triple}-gcc)
  set(CMAKE_CXX_COMPILER ${triple}-g++)
  # That GCC 10 passes some arguments in other registers than GCC 9 did.
  set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)
endif()
set(CMAKE_C_COMPILER_TARGET ${triple})
set(CMAKE_CXX_COMPILER_TARGET ${triple})
