// A render that was interrupted: what it was, as JSON, and its film.
//
//   "RTCHECK\n" | version | bytes of JSON | JSON {"film": its FilmDesc, "render": the caller's} | hash of JSON | film
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "Common/Image/Film.h"

namespace rt::image {

struct Checkpoint {
    nlohmann::json render; // whatever the caller compares before going on: settings, scene hash, engine
    Film film;
};

// Replaces the file atomically. Throws RenderError.
void writeCheckpoint(const std::filesystem::path& path, const nlohmann::json& render, const Film& film);
void writeCheckpoint(std::ostream& out, const nlohmann::json& render, const Film& film);

// The film is that of writeCheckpoint bit for bit. Throws InputError naming the file and what is wrong with it: not a
// checkpoint, another version, truncated, damaged.
Checkpoint readCheckpoint(const std::filesystem::path& path);
Checkpoint readCheckpoint(std::istream& in, const std::string& name);

// How long the film has been sampled, in which parts of one image differ; only films saved every so often tell.
inline constexpr const char* kSecondsField = "seconds";

// Choices that earlier programs did not have and checkpoints of theirs do not tell of: connections, split camera rays,
// paths that pixels share, motion blur.
inline constexpr const char* kLaterFields[] = {"specular_connections", "edge_rays", "path_reuse", "shutter",
                                               "motion_hash"};

// Adds those that are missing, as "off", to what the caller compares, and returns their names.
std::vector<std::string> addLaterFields(nlohmann::json& render);

} // namespace rt::image
