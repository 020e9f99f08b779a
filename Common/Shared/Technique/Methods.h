// Whether a method is in use: kernels and shaders may know more than a render asks for. A technique that is off costs
// nothing: without its feature bit there is no code, with it a test of one word.
#ifndef RT_SHARED_METHODS_H
#define RT_SHARED_METHODS_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

#ifndef RT_SPECIALIZED_FEATURES
RT_FN bool uses(Features features, RT_IN(RenderParams) params, Features method) {
    return has(features, method) && has(Features(0u, 0u, params.methods), method);
}
#else
// As has() is.
#define uses(features, params, method) ((kMethods & kMethodsInUse & (method).z) != 0u)
#endif

RT_SHARED_END

#endif
