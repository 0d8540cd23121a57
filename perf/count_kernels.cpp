// Each kernel of the movement once on each instruction set of this machine, between the lines
// "begin" and "end" on stdout, then what it was. perf/instructions runs it under qemu, where the
// plugin of part/count_instructions.c counts at each line.
#include <unistd.h>

#include <cmath>
#include <string>

#include "perf/bench_table.h"

namespace {

// At once, in one call of the system: a count belongs to each.
void tell(const std::string& line) {
  if (write(STDOUT_FILENO, line.data(), line.size()) < 0) std::exit(1);
}

}  // namespace

int main() {
  bench::Bench b(std::sqrt(20.0));  // about 5,000 vertices
  const std::string vertices = std::to_string(b.mesh.vertex_count());
  for (const plc::SimdTarget simd : plc::available_simd_targets()) {
    for (const auto& [name, kernel] : bench::kernel_table()) {
      b.reset();
      kernel(b, simd);
      b.reset();
      tell("begin\n");
      kernel(b, simd);
      tell("end\n");
      std::string line = name;
      for (const std::string& word :
           {std::string(plc::simd_target_name(simd)), vertices, std::to_string(b.hash())}) {
        line.append(1, ' ').append(word);
      }
      tell(line.append(1, '\n'));
    }
  }
  return 0;
}
