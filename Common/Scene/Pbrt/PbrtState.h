// What directives of pbrt files change, and AttributeEnd puts back.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtMaterials.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"

namespace rt::scene {

// The current transform at the start and at the end of the time that the shutter is open.
using PbrtTransforms = std::array<Affine, 2>;

struct PbrtState {
    PbrtTransforms transforms;
    std::array<bool, 2> isActive{true, true};
    bool isReversed = false;
    int material = PbrtMaterials::kUsual;
    std::shared_ptr<const PbrtParameters> areaLight; // null: none
    std::string inside;                              // the medium there; empty: none
    const PbrtColorSpace* space = nullptr;
    std::map<std::string, std::vector<PbrtParameter>> defaults; // by what they are of

    void concat(const Affine& map) {
        for (std::size_t i = 0; i < transforms.size(); ++i)
            if (isActive[i]) transforms[i] = transforms[i] * map;
    }
    void set(const PbrtTransforms& maps) {
        for (std::size_t i = 0; i < transforms.size(); ++i)
            if (isActive[i]) transforms[i] = maps[i];
    }
    bool moves() const {
        return transforms[0].linear != transforms[1].linear || transforms[0].offset != transforms[1].offset;
    }
};

} // namespace rt::scene
