// The bytes of a file, piece by piece, so that a text of any length takes little memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace rt::scene {

// Unpacks files that begin as gzip's do, whatever they are called; builds without zlib refuse those.
class PbrtBytes {
  public:
    // Opens it as openFile() does; throws InputError.
    explicit PbrtBytes(const std::filesystem::path& path);
    ~PbrtBytes();
    PbrtBytes(PbrtBytes&&) noexcept;
    PbrtBytes& operator=(PbrtBytes&&) noexcept;

    // How many of at most `most` bytes there were; 0: the file ends. Throws InputError.
    std::size_t read(char* to, std::size_t most);
    std::uint64_t size() const; // of the file, packed as it is

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace rt::scene
