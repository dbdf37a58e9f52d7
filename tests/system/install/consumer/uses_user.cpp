// SPDX-License-Identifier: Apache-2.0
extern "C" int triangles_of_a_square();
int main() { return triangles_of_a_square() == 2 ? 0 : 1; }
