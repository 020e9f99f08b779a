// What a flag takes, as its value is written in the help:
//
//     N, E, X,Y,W,H     something to type
//     a|b|c             one of these words; those in capitals stand for something to type: LIST|auto|all
//     a,b,c             some of these words, with commas
//     F, F.png|.exr     a file; one of these endings
//     DIR               a folder
//     SCENE             the id of a scene, or a scene file
#pragma once
#include <string>
#include <vector>

namespace rt::manual {

struct ValueForm {
    enum class Kind { Text, Words, File, Folder, Scene };
    Kind kind = Kind::Text;
    std::vector<std::string> words;   // of Kind::Words
    std::vector<std::string> endings; // of Kind::File and Kind::Scene, with their dots; empty: any file
    bool isList = false;              // several words, with commas
};

ValueForm formOf(const std::string& value);

} // namespace rt::manual
