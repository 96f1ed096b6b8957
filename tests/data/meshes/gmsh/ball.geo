// A ball of radius 10 mm about (1, 2, 3) mm.
SetFactory("OpenCASCADE");
Sphere(1) = {1, 2, 3, 10};
Mesh.MeshSizeMin = 7;
Mesh.MeshSizeMax = 7;
Physical Volume("ball", 1) = {1};
Physical Surface("skin", 2) = {1};
