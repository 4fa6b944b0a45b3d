// The main of every program.
#include "apps/common/programs.h"

int main(int argc, char** argv) {
    return cistula::CISTULA_PROGRAM(argc, argv);
}
