// A kernel that breaks the rule: the linker may share this instance of a template with any other object file.
template <class T>
T twice(T x) {
    return x + x;
}
template int twice(int);
