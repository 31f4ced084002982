#pragma once
// Where the project and the program under test lie. Only paths.cpp is told by the build, so that a compiler cache serves
// every other file in any checkout.

#include <string>

std::string source_dir();  ///< of the project, without a closing slash
std::string program_path();
