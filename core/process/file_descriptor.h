// A file descriptor, closed by the destructor.
#pragma once

#include <unistd.h>

#include <utility>

namespace footfall::core {

class FileDescriptor {
 public:
  FileDescriptor() = default;
  // Negative: none, as open() returns it on failure.
  explicit FileDescriptor(int number) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    if (this != &other) {
      close();
      number_ = std::exchange(other.number_, -1);
    }
    return *this;
  }
  ~FileDescriptor() { close(); }

  int get() const { return number_; }
  bool open() const { return number_ >= 0; }
  // False with errno set if the system reports that written data were lost.
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_ = -1;
};

}  // namespace footfall::core
