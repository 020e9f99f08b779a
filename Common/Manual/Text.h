// Text for help and for scripts of shells.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace rt::manual {

inline std::string joined(const std::vector<std::string>& parts, const std::string& separator) {
    std::string out;
    for (const std::string& part : parts) out += (out.empty() ? "" : separator) + part;
    return out;
}

// The name of a function of a program: _ray_tracing_cpu.
inline std::string functionOf(const std::string& program) {
    std::string name = "_" + program;
    std::replace(name.begin(), name.end(), '-', '_');
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

// `text` with a backslash before each of `special`.
inline std::string withBackslashes(const std::string& text, std::string_view special) {
    std::string out;
    for (const char c : text) {
        if (special.find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
    return out;
}

// Between single quotes of bash and zsh.
inline std::string singleQuoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

// Up to the first semicolon: what there is room for in one line.
inline std::string firstPart(const std::string& text) {
    return text.substr(0, text.find(';'));
}

} // namespace rt::manual
