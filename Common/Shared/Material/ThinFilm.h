// What a thin film on a surface reflects: light reflected above it and below it interferes. Belcour and Barla, "A
// Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", ACM TOG 36(4), 2017, with the
// approximations of KHR_materials_iridescence: Schlick's reflectance at both interfaces, no polarisation, air above.
#ifndef RT_SHARED_THIN_FILM_H
#define RT_SHARED_THIN_FILM_H
#include "Common/Shared/Base/Elementary.h"
#include "Common/Shared/Material/Microfacets.h"

RT_SHARED_BEGIN

// A Gaussian in wavenumbers, as its Fourier transform has it: an oscillation over the difference of paths, in nm, that
// dies away. `frequency` is in turns per nm.
RT_FN float filmWave(float amplitude, float frequency, float decay, float pathDifference) {
    float turns = frequency * pathDifference;
    return amplitude * sinCos2Pi(turns - floor(turns)).y * exponential(-decay * square(pathDifference));
}

// The colour, linear rgb with Rec. 709 primaries, of an oscillation over wavelengths with this difference of paths in
// nm, as observers see it (section 4 there, their fit to the CIE 1931 functions).
RT_FN vec3 filmSensitivity(float pathDifference) {
    float d = min(pathDifference, 1.0e5f); // by which all waves have died away
    float x = filmWave(0.846590f, 1.6810e-3f, 1.70855e-7f, d) + filmWave(0.153868f, 2.2399e-3f, 1.78766e-7f, d);
    float y = filmWave(1.000222f, 1.7953e-3f, 3.67331e-7f, d);
    float z = filmWave(1.001122f, 2.2084e-3f, 2.61035e-7f, d);
    return vec3(3.2404542f * x - 1.5371385f * y - 0.4985314f * z, -0.9692660f * x + 1.8760108f * y + 0.0415560f * z,
                0.0556434f * x - 0.2040259f * y + 1.0572252f * z);
}

// One colour channel of what is reflected: `base` is the reflectance at normal incidence of the surface below, in air;
// `once` and `twice` are the sensitivities to the difference of paths and to twice that.
RT_FN float filmChannel(float base, float ior, float above, float cosineInside, float once, float twice) {
    float root = sqrt(clamp(base, 0.0f, 0.9998f) + 0.0001f);
    float below = (1.0f + root) / (1.0f - root); // its index of refraction, were it a dielectric
    float normal = square((below - ior) / (below + ior));
    float second = normal + (1.0f - normal) * fifthPower(1.0f - cosineInside);
    float both = clamp(above * second, 1.0e-5f, 0.9999f);
    float through = 1.0f - above;
    float mean = square(through) * second / (1.0f - both);
    // Waves are turned over where the index rises: at both interfaces, or only above.
    float amplitude = sqrt(both);
    float first = (mean - through) * amplitude;
    float sum = above + mean + 2.0f * (below < ior ? first : -first) * once + 2.0f * first * amplitude * twice;
    return clamp(sum, 0.0f, 1.0f);
}

// What a film of this index of refraction and thickness, in nm, reflects at an angle of this cosine in air.
RT_FN vec3 filmReflectance(float cosine, float ior, float thickness, vec3 base) {
    float cosineInside = sqrt(max(1.0f - (1.0f - cosine) * (1.0f + cosine) / square(ior), 0.0f));
    float normal = square((ior - 1.0f) / (ior + 1.0f));
    float above = normal + (1.0f - normal) * schlick(cosine);
    float pathDifference = 2.0f * ior * thickness * cosineInside;
    vec3 once = filmSensitivity(pathDifference);
    vec3 twice = filmSensitivity(2.0f * pathDifference);
    return vec3(filmChannel(base.x, ior, above, cosineInside, once.x, twice.x),
                filmChannel(base.y, ior, above, cosineInside, once.y, twice.y),
                filmChannel(base.z, ior, above, cosineInside, once.z, twice.z));
}

RT_SHARED_END

#endif
