// The solid checker: cubes of two textures in world space.
#ifndef RT_SHARED_CHECKER_H
#define RT_SHARED_CHECKER_H
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

// Checkers within checkers, the outermost counted. The scene compiler refuses more, so that a lookup ends at something
// else.
const int kMaxCheckerDepth = 8;

// Whether the cell of the solid checker that holds p, cells of edge `scale`, is one of the even ones.
RT_FN bool isEvenCell(vec3 p, float scale) {
    vec3 cell = floor(p / scale);
    float sum = cell.x + cell.y + cell.z;
    return sum - 2.0f * floor(0.5f * sum) == 0.0f;
}

RT_SHARED_END

#endif
