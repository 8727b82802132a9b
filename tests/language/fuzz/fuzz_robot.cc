// Any bytes as a robot file, beside Hume's model.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "model/robot/description.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;

// Where files are memory: a disk that is busy elsewhere can hold up an open for more than a second,
// which would count against the loader.
fs::path memory_folder() {
  const fs::path shared = "/dev/shm";
  std::error_code ignored;
  return fs::is_directory(shared, ignored) ? shared : fs::temp_directory_path();
}

// A folder of this process with Hume's model in it; gone at its end.
struct Folder {
  fs::path path = memory_folder() / ("footfall_fuzz_" + std::to_string(getpid()));
  Folder() {
    fs::create_directories(path);
    fs::copy_file(FOOTFALL_SOURCE_DIR "/robots/hume/hume.xml", path / "hume.xml",
                  fs::copy_options::overwrite_existing);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

void load(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const std::string path = (folder.path / "robot.yaml").string();
  std::ofstream(path, std::ios::binary) << std::string(data, data + size);
  core::Diagnostics diagnostics;
  model::load_robot(path, diagnostics);
  static_cast<void>(diagnostics.to_string());
}

}  // namespace
}  // namespace footfall::tests

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  footfall::tests::load(data, size);
  return 0;
}
