// Whether the machine has the memory that a file asks for.
#pragma once
#include <cstdint>
#include <string>

namespace plc::tools {

// Bytes that the machine has left; 0 where the system does not say.
uint64_t available_memory();

// Of this process, without SharedBytes, of which it may not have touched all; in bytes, 0 where the
// system does not say.
uint64_t unshared_memory();

// Throws Failure where the machine has not `bytes` left.
void require_memory(const std::string& path, uint64_t bytes);

// Before so many bytes of voxels are unpacked or read, once it is known that the file can hold
// them: a reader apart gets time and memory for that.
void allow_for(uint64_t bytes);

}  // namespace plc::tools
