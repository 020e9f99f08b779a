// Pictures that other programs rendered, beside our own of the same scene: a row each.
#pragma once
#include <string>
#include <vector>

#include "Common/Bench/Analysis.h"
#include "Common/Bench/Suite.h"

namespace rt::bench {

// As --import is given them: NAME, IMAGE and SECONDS in turns. Throws UsageError.
std::vector<Import> parseImports(const std::vector<std::string>& words);

// Its scene and size must be one, which pictures without any other sign are then taken to show. Throws UsageError.
void checkOnePicture(const Suite& suite);

// Imports of one name are one curve. Of `like`, whose height is known, they have scene, size and depth. Throws
// InputError for what cannot be read, is of another size, or has a pixel that is no number.
std::vector<Measured> readImports(const std::vector<Import>& imports, const Config& like);

} // namespace rt::bench
