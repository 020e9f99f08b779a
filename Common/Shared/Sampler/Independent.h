// Random numbers that know nothing of each other.
#ifndef RT_SHARED_INDEPENDENT_H
#define RT_SHARED_INDEPENDENT_H
#include "Common/Shared/Sampler/PixelSampler.h"

RT_SHARED_BEGIN

RT_FN uvec2 independentWords(RT_IN(Sampler) s, uint dimension) {
    uvec3 h = hash3(uvec3(s.key, s.index, dimension));
    return uvec2(h.x, h.y);
}

RT_SHARED_END

#endif
