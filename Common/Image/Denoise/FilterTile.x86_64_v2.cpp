#include "Common/Image/Denoise/FilterTile.h"

rt::image::DenoiseKernel rt::image::denoiseKernel_x86_64_v2() {
    return filterTile;
}
