// A folder for files that another program reads or writes.
#pragma once
#include <filesystem>

namespace rt {

// Below the system's place for temporary files, readable by this user alone; gone with this. Throws RenderError where
// it cannot be made.
class OwnFolder {
  public:
    OwnFolder();
    ~OwnFolder();
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;

    std::filesystem::path operator/(const char* name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

} // namespace rt
