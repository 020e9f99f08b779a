// The image of a `launch` of the denoiser, which must be declared before.
bool isInside(ivec2 pixel) {
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x < int(launch.width) && pixel.y < int(launch.height);
}
uint pixelIndex(ivec2 pixel) {
    return uint(pixel.y) * launch.width + uint(pixel.x);
}
uint pixelCount() {
    return launch.width * launch.height;
}
