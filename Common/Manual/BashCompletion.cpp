#include <cstddef>
#include <string>

#include "Common/Manual/Formats.h"
#include "Common/Manual/Text.h"
#include "Common/Manual/Values.h"

namespace rt::manual {
namespace {

// Functions that complete words and files. Names with blanks stay whole; a folder leads on.
constexpr const char* kBashHelpers = R"(FUNCTION_words() {
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}

# The last of several words with commas.
FUNCTION_list() {
    local before=
    [[ $current != *,* ]] || before=${current%,*},
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${current##*,}")
    compopt -o nospace
}

# Files of these endings, or of any, and folders.
FUNCTION_files() {
    local ending
    if (($# == 0)); then
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    else
        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$current")
        for ending in "$@"; do
            mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!*$ending" -- "$current")
        done
    fi
    compopt -o filenames
}

)";

std::string bashAction(const Flag& flag, const std::string& function, const SceneIds& scenes) {
    const ValueForm form = formOf(flag.value);
    std::string files = function + "_files " + joined(form.endings, " ");
    switch (form.kind) {
        case ValueForm::Kind::Words:
            return function + (form.isList ? "_list '" : "_words '") + joined(form.words, " ") + "'";
        case ValueForm::Kind::File:
            return files;
        case ValueForm::Kind::Folder:
            return "mapfile -t COMPREPLY < <(compgen -d -- \"$current\"); compopt -o filenames";
        case ValueForm::Kind::Scene:
            return function + "_words '" + joined(scenes, " ") + "'; " + files;
        case ValueForm::Kind::Text:
            break;
    }
    return ":";
}

// The cases of `previous`, a flag that takes a value.
std::string bashCases(const Page& page, const std::string& function, const SceneIds& scenes) {
    std::string cases;
    for (const Flag& flag : page.flags)
        if (!flag.value.empty())
            cases += "        " + joined(flag.names, "|") + ") " + bashAction(flag, function, scenes) + "; " +
                     (flag.mayOmitValue ? "((${#COMPREPLY[@]})) && " : "") + "return ;;\n";
    return cases.empty() ? cases : "    case $previous in\n" + cases + "    esac\n";
}

std::string bashFlags(const Page& page) {
    std::string words;
    for (const Flag& flag : page.flags) words += (words.empty() ? "" : " ") + joined(flag.names, " ");
    return words;
}

// What completes a word that is no flag and follows none: the arguments are alike.
std::string bashBody(const Page& page, const std::string& function, const SceneIds& scenes) {
    std::string body = bashCases(page, function, scenes);
    body += "    if [[ $current == -* ]]; then\n        " + function + "_words '" + bashFlags(page) + "'\n";
    if (!page.arguments.empty())
        body += "    else\n        " + bashAction(page.arguments.front(), function, scenes) + "\n";
    return body + "    fi\n";
}

} // namespace

std::string bashCompletion(const Page& page, const SceneIds& scenes) {
    const std::string function = functionOf(page.name);
    std::string helpers = kBashHelpers;
    for (std::size_t at; (at = helpers.find("FUNCTION")) != std::string::npos;) helpers.replace(at, 8, function);

    std::string out = "# Completion of " + page.name + " for bash.\n" + helpers;
    std::string choice, names;
    for (const Page& command : page.commands) {
        const std::string name = command.name.substr(page.name.size() + 1);
        out += functionOf(command.name) + "() {\n" + bashBody(command, function, scenes) + "}\n\n";
        choice += "        " + name + ") " + functionOf(command.name) + "; return ;;\n";
        names += (names.empty() ? "" : " ") + name;
    }
    out += function + "() {\n    local current=$2 previous=$3\n    COMPREPLY=()\n";
    // --flag=value comes as three words.
    out +=
        "    if [[ $previous == = ]]; then\n        previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
        "    elif [[ ${COMP_WORDS[COMP_CWORD]} == = ]]; then\n        current=\n    fi\n";
    if (!page.commands.empty())
        out += "    if ((COMP_CWORD == 1)); then\n        " + function + "_words '" + names + " " + bashFlags(page) +
               "'\n        return\n    fi\n    case ${COMP_WORDS[1]} in\n" + choice + "    esac\n";
    else
        out += bashBody(page, function, scenes);
    return out + "}\n\ncomplete -F " + function + " " + page.name + "\n";
}

} // namespace rt::manual
