# What a build for WebAssembly takes of the machine that it is made on: headers alone. With one target
# nothing of Highway's library is called.
foreach(header IN ITEMS hwy/highway.h catch2/catch.hpp)
  cmake_path(GET header PARENT_PATH folder)
  find_path(with_${folder} ${header} PATHS /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
  if(NOT with_${folder})
    message(FATAL_ERROR "${header}: not found in /usr/include")
  endif()
  # Beside it are the headers of another machine's C library.
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/headers/${folder})
  file(CREATE_LINK ${with_${folder}}/${folder} ${PROJECT_BINARY_DIR}/headers/${folder}/${folder} SYMBOLIC)
endforeach()
add_library(hwy::hwy INTERFACE IMPORTED)
target_include_directories(hwy::hwy SYSTEM INTERFACE ${PROJECT_BINARY_DIR}/headers/hwy)
add_library(Catch2::Catch2 INTERFACE IMPORTED)
target_include_directories(Catch2::Catch2 SYSTEM INTERFACE ${PROJECT_BINARY_DIR}/headers/catch2)
set(Catch2_FOUND ON)
add_library(Threads::Threads INTERFACE IMPORTED)

# Exceptions of WebAssembly itself. No relaxed SIMD: it rounds as the machine likes.
add_compile_options(-msimd128 -fwasm-exceptions)
add_link_options(-fwasm-exceptions -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4GB)
