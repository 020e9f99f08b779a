// How many samples a pixel has, numbered as in the film, where its slot has `end`: a plan may give it fewer.
uint pixelEnd(FilmLaunch launch, uint pixel, uint end) {
    if ((launch.flags & kIsPlanned) == 0u) return end;
    return min(end, launch.plan.at[pixel]);
}
