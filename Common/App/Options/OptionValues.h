// From the text of a flag's value to the value. Every failure is a UsageError: "--spp 0: must be a whole number from 1
// to …".
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "Common/Render/Names.h"

namespace rt::app {

// As much of a text as an error quotes.
std::string excerpt(const std::string& text);

[[noreturn]] void refuseValue(const std::string& flag, const std::string& text, const std::string& allowed);

// "a", "a or b", "a, b or c".
std::string alternatives(const std::vector<std::string>& names);

std::uint32_t parseWhole(const std::string& flag, const std::string& text, std::uint32_t min, std::uint32_t max);

// A finite number in [min, max]; `allowed` says so in the error.
double parseReal(const std::string& flag, const std::string& text, double min, double max, const std::string& allowed);

// The parts of "a,b,c", which must not be empty.
std::vector<std::string> parseList(const std::string& flag, const std::string& text);

template <class E, std::size_t N>
E parseChoice(const std::string& flag, const std::string& text, const Named<E> (&table)[N]) {
    std::vector<std::string> names;
    for (const auto& row : table) {
        if (row.name == text) return row.value;
        names.emplace_back(row.name);
    }
    refuseValue(flag, text, alternatives(names));
}

} // namespace rt::app
