// What two versions of a scene have in common, so that what was built of one serves the other.
#pragma once
#include <cstdint>
#include <cstring>
#include <span>

#include "Common/Accel/AccelInput.h"

namespace rt::accel {

// Of the same geometry in both: whether primitive after primitive is where it was. Materials, lights and where in the
// arrays the primitives stand do not count.
bool sameSurfaces(const AccelInput& a, const AccelInput& b, std::uint32_t geometry); // triangles and quads
bool sameSpheres(const AccelInput& a, const AccelInput& b, std::uint32_t geometry);
bool sameRounds(const AccelInput& a, const AccelInput& b, std::uint32_t geometry);
bool sameInstances(const AccelInput& a, const AccelInput& b);

template <class T>
bool sameArray(std::span<const T> a, std::span<const T> b) { // to the byte
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

// Whether all geometries that instances place are the same and stand where they stood in the arrays. What is in the
// world, and where instances are, does not count.
bool samePlacedGeometries(const AccelInput& a, const AccelInput& b);

// Whether all of it is the same, to the byte.
bool sameInput(const AccelInput& a, const AccelInput& b);

} // namespace rt::accel
