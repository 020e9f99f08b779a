// Where files are found: programs run from any working directory.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

namespace rt {

// Absolute path of the running program; empty where the platform does not tell.
std::filesystem::path executablePath();

// The program of this name in a folder of $PATH; empty where none has it.
std::filesystem::path findProgram(const char* name);

// $XDG_CACHE_HOME/ray-tracing or the platform's place for what can be made again; empty when the environment names
// none.
std::filesystem::path userCacheFolder();

// $XDG_STATE_HOME/ray-tracing or the platform's place for what a program keeps of its work; empty when the environment
// names none.
std::filesystem::path userStateFolder();

// Folders searched for assets, in order: $RT_ASSETS; Assets beside the program or in a folder around it, as in the
// source tree that it was built in; share/ray-tracing-twins below the prefix that it was installed to. Only folders
// that exist.
std::vector<std::filesystem::path> assetFolders();

// Of a library that a program of others has loaded: assetFolders() looks around its file, too, before the program's.
// To be called by one thread, before any other asks.
void findAssetsAround(const std::filesystem::path& library);

// An asset by its name relative to an asset folder, e.g. "textures/mars.jpg"; nothing when no folder has such a file.
std::optional<std::filesystem::path> findAsset(const std::filesystem::path& name);

// Where a package of the system puts maps of planets, xplanet-images on Debian; $RT_PLANET_MAPS in its place where that
// is set, also to nothing. Empty: there is no such folder.
std::filesystem::path planetMapFolder();

} // namespace rt
