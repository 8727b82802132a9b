// Pictures; see image.h. The only file that contains stb's PNG implementation.
#include "sim/view/image.h"

#include <algorithm>
#include <stdexcept>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include "core/process/machine_error.h"
#include "core/text/whole_file.h"

namespace footfall::sim {

void Image::paste(const Image& tile, int left, int top) {
  const int first = std::max(0, -left);
  const int columns = std::min(tile.width, width - left) - first;
  if (columns <= 0) return;
  for (int row = std::max(0, -top); row < std::min(tile.height, height - top); ++row) {
    const auto from = static_cast<std::size_t>(row) * static_cast<std::size_t>(tile.width) +
                      static_cast<std::size_t>(first);
    const auto to = static_cast<std::size_t>(top + row) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(left + first);
    std::copy_n(tile.rgb.data() + 3 * from, 3 * columns, rgb.data() + 3 * to);
  }
}

std::vector<std::uint8_t> encode_png(const Image& image) {
  std::vector<std::uint8_t> bytes;
  const auto append = [](void* context, void* data, int size) {
    auto& out = *static_cast<std::vector<std::uint8_t>*>(context);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), begin, begin + size);
  };
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(),
                             3 * image.width) == 0) {
    throw core::MachineError("cannot encode a picture of " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " pixels");
  }
  return bytes;
}

void write_png(const Image& image, const std::string& path) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  core::write_whole_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace footfall::sim
