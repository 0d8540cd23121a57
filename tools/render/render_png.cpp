#include "tools/render/render_png.h"

#include <png.h>

#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"

namespace plc::tools {

void write_png(const std::string& path, const Picture& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) ==
      0) {
    throw Failure{path + ": " + image.message};
  }
  bytes.resize(size);
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace plc::tools
