// What specialization constants can rule out, for the test of vulkan::prunedShader().
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kBits = 0u;
#define IS_ON(bit) ((kBits & (bit)) != 0u)
layout(buffer_reference, scalar) buffer Results { uvec4 at[]; };
layout(push_constant, scalar) uniform Launch {
    Results results;
    uint count;
};

uint calledWithBit(uint x) {
    return x * 2654435761u;
}
bool isRare(uint x) { // never, where its bit is off
    return IS_ON(1u) && x % 3u == 0u;
}
bool isCommon(uint x) { // always, where its bit is on
    return IS_ON(2u) || x % 5u == 0u;
}
uint sumWithExits(uint x) {
    uint sum = 0u;
    for (uint k = 0u; k < x % 11u; ++k) {
        if (IS_ON(4u)) continue;
        if (IS_ON(8u) && k > 3u) break;
        sum += k;
    }
    return sum;
}
uint firstOfLoop(uint x) { // a loop that ends in its first turn, or goes on
    uint sum = x;
    for (;;) {
        if (IS_ON(8u)) break;
        sum = sum * 3u + 1u;
        if (sum > 1000u) return sum;
    }
    return sum + 7u;
}
uint bothArmsReturn(uint x) {
    if (isCommon(x)) {
        if (!isRare(x)) return 17u;
        return calledWithBit(x);
    } else {
        return x;
    }
}
uint byCase(uint x) {
    switch (x & 3u) {
        case 0u:
            return IS_ON(1u) ? 5u : 6u;
        case 1u:
            if (IS_ON(2u)) break;
            return 7u;
        case 2u:
            x += 100u; // and on
        default:
            x ^= 0x55u;
    }
    if (IS_ON(4u) == IS_ON(8u)) x += 3u;
    return x;
}
bool byVariables(uint x) { // without bits 1 and 2 never: what `first` is stands in a variable of one value
    bool first = x % 7u < 4u && isRare(x);
    bool second = false;
    if (IS_ON(2u)) second = x % 2u == 0u;
    if (!first && !second) return false;
    return x % 3u != 1u;
}
uint nested(uint x) {
    uint sum = 0u;
    for (uint i = 0u; i < 3u; ++i) {
        for (uint j = 0u; j < 3u; ++j) {
            if (isRare(x + i) && isCommon(x + j)) sum += calledWithBit(i);
            if (isCommon(x + j) || !isRare(x + i)) sum += j;
            if (kBits > 9u && j == 2u) return sum;
        }
        if (kBits >= 4u && kBits <= 6u) continue;
        ++sum;
    }
    return sum;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    bool isEven = (i & 1u) == 0u;
    uint mixed = (isEven && !IS_ON(1u)) || (IS_ON(8u) && !isEven) ? 1u : 2u;
    results.at[i] = uvec4(sumWithExits(i) + firstOfLoop(i) * 256u, bothArmsReturn(i), byCase(i) + mixed * 65536u,
                          nested(i) + (byVariables(i) ? calledWithBit(i) : 0u));
}
