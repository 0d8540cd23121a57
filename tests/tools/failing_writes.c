// For LD_PRELOAD: call number PELLICLE_FAIL_AT, counted from 1, of those that make, write, sync,
// close or rename an output file of tools/file/atomic_file.cpp, or sync a folder, fails as on a
// full disk, and so do all later writes and makings; then the file PELLICLE_FAILED is made. Of a
// write that fails, half is written before.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { kDescriptors = 1024 };
static bool output[kDescriptors];
static long calls;
static bool full;

static bool fails(void) {
  const char* at = getenv("PELLICLE_FAIL_AT");
  const char* mark = getenv("PELLICLE_FAILED");
  if (at == NULL || mark == NULL || ++calls != atol(at)) return false;
  full = true;
  const long made = syscall(SYS_openat, AT_FDCWD, mark, O_CREAT | O_WRONLY, 0666);
  if (made >= 0) syscall(SYS_close, (int)made);
  return true;
}

static bool is_output(int descriptor) {
  return descriptor >= 0 && descriptor < kDescriptors && output[descriptor];
}

static int no_space(void) {
  errno = ENOSPC;
  return -1;
}

// Output files are those that must not be there before.
int open(const char* name, int flags, ...) {
  typedef int Call(const char*, int, ...);
  Call* const next = (Call*)dlsym(RTLD_NEXT, "open");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if ((flags & O_EXCL) == 0) return next(name, flags, mode);
  if (fails() || full) return no_space();
  const int made = next(name, flags, mode);
  if (made >= 0 && made < kDescriptors) output[made] = true;
  return made;
}

int fsync(int descriptor) {
  typedef int Call(int);
  return fails() ? no_space() : ((Call*)dlsym(RTLD_NEXT, "fsync"))(descriptor);
}

int syncfs(int descriptor) {
  typedef int Call(int);
  return fails() ? no_space() : ((Call*)dlsym(RTLD_NEXT, "syncfs"))(descriptor);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  typedef ssize_t Call(int, const void*, size_t);
  Call* const next = (Call*)dlsym(RTLD_NEXT, "write");
  if (!is_output(descriptor)) return next(descriptor, data, size);
  if (full) return no_space();
  if (!fails()) return next(descriptor, data, size);
  return size > 1 ? next(descriptor, data, size / 2) : no_space();
}

int close(int descriptor) {
  typedef int Call(int);
  const int closed = ((Call*)dlsym(RTLD_NEXT, "close"))(descriptor);
  if (!is_output(descriptor)) return closed;
  output[descriptor] = false;
  return fails() ? no_space() : closed;
}

int rename(const char* from, const char* to) {
  typedef int Call(const char*, const char*);
  if (fails()) return no_space();
  return ((Call*)dlsym(RTLD_NEXT, "rename"))(from, to);
}
