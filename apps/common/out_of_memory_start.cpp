// Makes programs end in one line where memory runs out in static constructors too, those of libraries included.
#include "scene/base/out_of_memory.h"

namespace {

using Start = void (*)(int, char**, char**);

void start(int, char**, char**) {
    cistula::end_when_out_of_memory();
}

[[gnu::section(".preinit_array"), gnu::used]] const Start entry = start;

}  // namespace
