// A picture in memory and its PNG encoding. After a run, for films and reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace footfall::sim {

// 8-bit RGB, top row first, rows without padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Image() = default;
  Image(int columns, int rows, std::uint8_t gray = 255)
      : width(columns),
        height(rows),
        rgb(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), gray) {}
  // Copies `tile` with its upper left corner at (left, top), clipped to this picture.
  void paste(const Image& tile, int left, int top);
};

// The picture as the bytes of a PNG file.
std::vector<std::uint8_t> encode_png(const Image& image);

// Throws std::runtime_error with one sentence that names the path on failure.
void write_png(const Image& image, const std::string& path);

}  // namespace footfall::sim
