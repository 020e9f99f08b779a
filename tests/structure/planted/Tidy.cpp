// A fault that Tidy.cmake must find, in a file that a merged source includes: 0 for a null pointer.
const int* plantedPointer() {
    return 0;
}
