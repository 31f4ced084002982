#include "support/paths.h"

std::string source_dir() { return CALOT_SOURCE_DIR; }
std::string program_path() { return CALOT_PROGRAM; }
