#include "Common/Manual/Page.h"

#include <algorithm>
#include <cstddef>
#include <sstream>

#include <CLI/CLI.hpp>

namespace rt::manual {
namespace {

constexpr const char* kLastGroup = "Program"; // what all programs have, after what this one is for
constexpr int kManyValues = 1000;             // an option with more takes as many as the user gives
constexpr const char* kUngrouped = "Options"; // what CLI11 calls flags without a group
constexpr const char* kChoiceIndent = "  ";   // before "name: help" of a choice, below the paragraph

// "help\n  name: help\n  ..." as FlagSet::addChoice() joins them.
void splitHelp(const std::string& text, Flag& flag) {
    std::istringstream lines(text);
    std::getline(lines, flag.help);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t colon = line.find(": ");
        if (!line.starts_with(kChoiceIndent) || colon == std::string::npos)
            flag.help += " " + line;
        else
            flag.choices.push_back({line.substr(2, colon - 2), line.substr(colon + 2)});
    }
}

Flag flagOf(const CLI::Option& option) {
    Flag flag;
    if (option.nonpositional()) {
        for (const std::string& name : option.get_lnames()) flag.names.push_back("--" + name);
        for (const std::string& name : option.get_snames()) flag.names.push_back("-" + name);
    } else {
        flag.names = {option.get_name(true)};
    }
    const bool isSwitch = option.get_expected_max() == 0;
    if (!isSwitch) flag.value = option.get_type_name();
    splitHelp(option.get_description(), flag);
    if (!isSwitch) flag.byDefault = option.get_default_str();
    flag.group = option.get_group() == kUngrouped ? kLastGroup : option.get_group();
    flag.isRepeatable = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll ||
                        option.get_items_expected_max() > kManyValues;
    flag.mayOmitValue = !isSwitch && option.get_expected_min() == 0;
    flag.isRequired = option.get_required();
    return flag;
}

} // namespace

Page pageOf(const CLI::App& app) {
    Page page;
    page.name = app.get_name();
    page.summary = app.get_description();
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;
        (option->nonpositional() ? page.flags : page.arguments).push_back(flagOf(*option));
    }
    std::stable_partition(page.flags.begin(), page.flags.end(),
                          [](const Flag& flag) { return flag.group != kLastGroup; });
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        page.commands.push_back(pageOf(*command));
        page.commands.back().name = page.name + " " + command->get_name();
    }
    return page;
}

const Flag* findFlag(const Page& page, const std::string& name) {
    for (const Flag& flag : page.flags)
        if (std::find(flag.names.begin(), flag.names.end(), name) != flag.names.end()) return &flag;
    return nullptr;
}

std::vector<std::string> groupsOf(const Page& page) {
    std::vector<std::string> groups;
    for (const Flag& flag : page.flags)
        if (std::find(groups.begin(), groups.end(), flag.group) == groups.end()) groups.push_back(flag.group);
    return groups;
}

std::string usageOf(const Page& page) {
    std::string usage = page.name + (page.commands.empty() ? " [FLAGS]" : " COMMAND [FLAGS]");
    for (const Flag& argument : page.arguments) {
        const std::string name = argument.names.front() + (argument.isRepeatable ? "..." : "");
        usage += argument.isRequired ? " " + name : " [" + name + "]";
    }
    return usage;
}

std::string spellingsOf(const Flag& flag) {
    std::string text;
    for (const std::string& name : flag.names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

std::string shownValue(const Flag& flag) {
    return flag.mayOmitValue ? "[" + flag.value + "]" : flag.value;
}

const std::vector<Term>& exitCodes() {
    static const std::vector<Term> codes = {
        {"0", "done"},
        {"1", "a render, a device or an output failed"},
        {"2", "wrong flags or values"},
        {"3", "an input is missing or invalid: scene, asset, reference, checkpoint"},
        {"4", "no suitable device"},
        {"5", "images or reports differ by more than was asked for"},
        {"130", "interrupted; the image and the statistics are written as far as they are"}};
    return codes;
}

} // namespace rt::manual
