// A bracket of 60 mm with a boss and a web, tilted, in millimetres. Gmsh: gmsh -3 bracket.geo
SetFactory("OpenCASCADE");

h = 1.6; // size of the cells [mm]

Box(1) = {0, 0, 0, 60, 40, 10};
Cylinder(2) = {15, 20, 0, 0, 0, 25, 9};
Box(3) = {30, 15, 10, 25, 10, 12};
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
Cylinder(5) = {15, 20, -1, 0, 0, 30, 5};
Cylinder(6) = {42, 20, -1, 0, 0, 12, 3};
BooleanDifference(7) = { Volume{4}; Delete; }{ Volume{5, 6}; Delete; };
Rotate {{0, 1, 0}, {0, 0, 0}, 0.25} { Volume{7}; }
Rotate {{1, 0, 0}, {0, 0, 0}, 0.2} { Volume{7}; }

Physical Volume("bracket") = {7};
Physical Surface("skin") = Boundary { Volume{7}; };

Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
Mesh.ElementOrder = 2;
