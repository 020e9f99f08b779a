#include "Common/Image/Denoise/FilterTile.h"

rt::image::DenoiseKernel rt::image::denoiseKernel_generic() {
    return filterTile;
}
