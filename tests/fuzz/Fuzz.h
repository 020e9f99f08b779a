// What the fuzz targets share. A target passes an input when its reader takes or refuses it: whatever else happens, a
// signal, another exception, a finding of a sanitizer, too much memory or time, is a find.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/ReadFile.h"
#include "tests/TempFolder.h"

namespace rt::test {

// The folder of all inputs of a process, removed with it. readFile() reads nothing outside.
class FuzzFolder {
  public:
    std::filesystem::path write(const std::string& name, std::string_view bytes) const {
        const std::filesystem::path path = folder_ / name;
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }
    const std::filesystem::path& path() const { return folder_.path(); }

  private:
    TempFolder folder_;
    ReadsBelow confined_{folder_.path(), {}};
};

inline FuzzFolder& fuzzFolder() {
    static FuzzFolder folder;
    return folder;
}

// Calls what reads; its documented refusal is fine.
template <class Function>
void readOrRefuse(const Function& read) {
    try {
        read();
    } catch (const Error&) {
    }
}

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

} // namespace rt::test
