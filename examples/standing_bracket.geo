// A bracket of 60 mm with a boss and a web that stands on two feet, in millimetres.
SetFactory("OpenCASCADE");

h = 3; // size of the cells [mm]

Box(1) = {0, 0, 0, 60, 40, 10};
Cylinder(2) = {15, 20, 0, 0, 0, 25, 9};
Box(3) = {30, 15, 10, 25, 10, 12};
Box(4) = {0, 0, -2, 6, 40, 2};
Box(5) = {54, 0, -2, 6, 40, 2};
BooleanUnion(6) = { Volume{1}; Delete; }{ Volume{2, 3, 4, 5}; Delete; };
Cylinder(7) = {15, 20, -3, 0, 0, 30, 5};
BooleanDifference(8) = { Volume{6}; Delete; }{ Volume{7}; Delete; };

Physical Volume("bracket") = {8};
feet() = Surface In BoundingBox {-1, -1, -2.1, 61, 41, -1.9};
Physical Surface("feet") = {feet()};

Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
Mesh.ElementOrder = 1;
