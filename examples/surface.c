/* SPDX-License-Identifier: Apache-2.0 */
/* cc surface.c $(pkg-config --cflags --libs palpate) -o surface && ./surface library.h5 > body.obj
 * The response surface as an OBJ file, with outward normals, for a viewer or an engine. */
#include <palpate.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  palpate_library* library;
  palpate_library_info info = {.size = sizeof info};
  if (argc < 2 || palpate_library_load(argv[1], &library))
    return fprintf(stderr, "surface: %s\n", argc < 2 ? "give LIBRARY" : palpate_last_error()), 1;
  palpate_library_describe(library, &info);
  const size_t vertices = (size_t)info.vertices, triangles = (size_t)info.triangles;
  double* x = malloc(3 * vertices * sizeof *x);
  double* n = malloc(3 * vertices * sizeof *n);
  int32_t* t = malloc(3 * triangles * sizeof *t);
  if (!x || !n || !t || palpate_library_vertices(library, x, vertices) ||
      palpate_library_normals(library, n, vertices) ||
      palpate_library_triangles(library, t, triangles))
    return fprintf(stderr, "surface: %s\n", palpate_last_error()), 1;
  for (size_t v = 0; v < vertices; ++v)
    printf("v %.9g %.9g %.9g\nvn %.6f %.6f %.6f\n", x[3 * v], x[3 * v + 1], x[3 * v + 2], -n[3 * v],
           -n[3 * v + 1], -n[3 * v + 2]);
  for (size_t m = 0; m < triangles; ++m)
    printf("f %d//%d %d//%d %d//%d\n", t[3 * m] + 1, t[3 * m] + 1, t[3 * m + 1] + 1,
           t[3 * m + 1] + 1, t[3 * m + 2] + 1, t[3 * m + 2] + 1);
  free(x), free(n), free(t);
  palpate_library_destroy(library);
}
