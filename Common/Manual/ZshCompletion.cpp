#include <string>
#include <vector>

#include "Common/Manual/Formats.h"
#include "Common/Manual/Text.h"
#include "Common/Manual/Values.h"

namespace rt::manual {
namespace {

// A pattern of files of these endings; empty: all files.
std::string zshPattern(const std::vector<std::string>& endings) {
    if (endings.empty()) return "";
    std::string names;
    for (const std::string& ending : endings) names += (names.empty() ? "" : "|") + ending.substr(1);
    return " -g \"*.(" + names + ")\"";
}

std::string zshAction(const Flag& flag, const std::string& sceneFunction) {
    const ValueForm form = formOf(flag.value);
    switch (form.kind) {
        case ValueForm::Kind::Words:
            return form.isList ? "{_values -s , value " + joined(form.words, " ") + "}"
                               : "(" + joined(form.words, " ") + ")";
        case ValueForm::Kind::File:
            return "_files" + zshPattern(form.endings);
        case ValueForm::Kind::Folder:
            return "_files -/";
        case ValueForm::Kind::Scene:
            return sceneFunction;
        case ValueForm::Kind::Text:
            break;
    }
    return " ";
}

// ":message:action", or "::" where the value may be left out.
std::string zshValue(const Flag& flag, const std::string& sceneFunction) {
    if (flag.value.empty()) return "";
    return (flag.mayOmitValue ? "::" : ":") + withBackslashes(flag.value, ":\\") + ":" + zshAction(flag, sceneFunction);
}

// Arguments of _arguments, a line for each spelling.
std::string zshSpecs(const Page& page, const std::string& sceneFunction) {
    std::string specs;
    for (const Flag& flag : page.flags) {
        const std::string text = withBackslashes(firstPart(flag.help), "[]:\\");
        const std::string others = flag.isRepeatable ? "*" : "(" + joined(flag.names, " ") + ")";
        for (const std::string& name : flag.names) {
            // --flag VALUE and --flag=VALUE
            const std::string form = name + (!flag.value.empty() && name.starts_with("--") ? "=" : "");
            specs += " \\\n        " + singleQuoted(others + form + "[" + text + "]" + zshValue(flag, sceneFunction));
        }
    }
    for (const Flag& argument : page.arguments)
        specs += " \\\n        " +
                 singleQuoted((argument.isRepeatable ? "*" : "") + (argument.isRequired ? std::string(":") : "::") +
                              argument.names.front() + ":" + zshAction(argument, sceneFunction));
    return specs;
}

} // namespace

std::string zshCompletion(const Page& page, const SceneIds& scenes) {
    const std::string function = functionOf(page.name), sceneFunction = function + "_scenes";
    std::string out = "#compdef " + page.name + "\n# Completion of " + page.name + " for zsh.\n\n";
    out += sceneFunction + "() {\n    _alternative 'ids:scene:(" + joined(scenes, " ") + ")' 'files:scene file:_files" +
           zshPattern(formOf("SCENE").endings) + "'\n}\n\n";
    out += function + "() {\n    local curcontext=$curcontext state line\n    typeset -A opt_args\n";
    if (page.commands.empty()) {
        out += "    _arguments -s -S" + zshSpecs(page, sceneFunction) + "\n";
    } else {
        std::string names, cases;
        for (const Page& command : page.commands) {
            const std::string name = command.name.substr(page.name.size() + 1);
            names += (names.empty() ? "" : " ") + name;
            cases +=
                "    " + name + ")\n        _arguments -s -S" + zshSpecs(command, sceneFunction) + "\n        ;;\n";
        }
        out += "    _arguments -C -s -S" + zshSpecs(page, sceneFunction) + " \\\n        " +
               singleQuoted("1:command:(" + names + ")") + " \\\n        '*::argument:->arguments'\n" +
               "    [[ $state == arguments ]] || return\n    case $line[1] in\n" + cases + "    esac\n";
    }
    return out + "}\n\n" + function + " \"$@\"\n";
}

} // namespace rt::manual
