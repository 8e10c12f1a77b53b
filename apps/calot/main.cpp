#include <cstdio>
int main() { std::puts("calot"); return 0; }
