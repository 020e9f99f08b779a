// Generated substitutes for assets that cannot be shipped: planet maps and a statue. The same on every machine.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// "earth", "earth-night", "mars", "venus": latitude-longitude maps, 1024 x 512, sRGB.
const std::vector<std::string>& planetMapNames();
TexelData makePlanetMap(const std::string& name);    // one of the names
const std::vector<std::string>& imageStandInNames(); // these and kWhiteStandIn

// A real map of the planet that a package of the system brought; empty: there is none.
std::filesystem::path installedPlanetMap(const std::string& name);

// "statue": a winged figure on the size and place of the Stanford Lucy model (about 870 units high along +Y from y =
// 15, facing -X), a closed surface of about 450 000 triangles with normals. "statue-fine": of about a million.
const std::vector<std::string>& meshStandInNames();
MeshData makeMeshStandIn(const std::string& name); // one of the names

// Where a file named by scene `id` is: its full path, or an asset. Nothing: the stand-in takes over, because there is
// no such file or the options prefer what is generated. One whose name differs in case is taken, with a notice. Throws
// InputError for a missing file without stand-in.
std::optional<std::filesystem::path> locateAsset(const std::string& file, const std::string& standIn,
                                                 const CompileOptions& options, const std::string& id,
                                                 std::vector<std::string>& notices);

} // namespace rt::scene
