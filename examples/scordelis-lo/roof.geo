// A quarter of the Scordelis-Lo roof: a part of a cylinder about the y axis, from the crown (x = 0) to the free edge 40 degrees off, from midspan (y = 0) to the end diaphragm.
// gmsh -2 -order 2 -format msh41 roof.geo
SetFactory("OpenCASCADE");
R = 25;
alpha = 40*Pi/180;
half = 25;  // of the length
Point(1) = {0, 0, 0};
Point(2) = {0, 0, R};
Point(3) = {R*Sin(alpha), 0, R*Cos(alpha)};
Circle(1) = {2, 1, 3};
Extrude {0, half, 0} { Curve{1}; }

Transfinite Curve {:} = 7;  // 6 cells along each side
Transfinite Surface {:};
Recombine Surface {:};

Physical Surface("roof") = {1};
Physical Curve("midspan") = {1};
Physical Curve("crown") = {2};
Physical Curve("edge") = {3};  // free
Physical Curve("end") = {4};
