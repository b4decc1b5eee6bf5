// An L of two legs, centre lines of 240 mm and 30 mm wide, in the plane z = 0: one along x from the clamped end, one down from the corner to the loaded end.
// gmsh -2 -order 2 -format msh41 frame.geo
length = 255;  // of the outer edges
width = 30;
across = 2;  // cells across a leg
along = 14;  // and along it, up to the corner

Point(1) = {0, -width, 0};
Point(2) = {length - width, -width, 0};
Point(3) = {length - width, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {length, -width, 0};
Point(6) = {length, 0, 0};
Point(7) = {length - width, -length, 0};
Point(8) = {length, -length, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {2, 5};
Line(6) = {5, 6};
Line(7) = {6, 3};
Line(8) = {7, 8};
Line(9) = {8, 5};
Line(10) = {2, 7};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, -2};
Curve Loop(3) = {10, 8, 9, -5};
For i In {1:3}
  Plane Surface(i) = {i};
EndFor
Transfinite Curve {2, 4, 5, 6, 7, 8} = across + 1;
Transfinite Curve {1, 3, 9, 10} = along + 1;
Transfinite Surface {:};
Recombine Surface {:};

Physical Surface("frame") = {1:3};
Physical Curve("clamp") = {4};
Physical Curve("end") = {8};
