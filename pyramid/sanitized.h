// Whether the build is watched by sanitizers, or by valgrind (tools/sanitize): memory then comes
// from the C library's allocator, which they take the place of and which knows its ends.
#pragma once

#ifndef PLC_SANITIZED_MEMORY
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PLC_SANITIZED_MEMORY 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PLC_SANITIZED_MEMORY 1
#endif
#endif
#endif
#ifndef PLC_SANITIZED_MEMORY
#define PLC_SANITIZED_MEMORY 0
#endif
