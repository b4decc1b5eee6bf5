// An eighth of a thick hollow sphere around the origin, three blocks of second-order hexahedra.
// gmsh -3 -order 2 -format msh41 octant.geo
inner = 50;
outer = 52;
n = 3;       // cells along half of a quarter of a circle
layers = 1;  // through the wall

Point(100) = {0, 0, 0};
s = Sqrt(2)/2;
g = Sqrt(3)/3;
For k In {0:1}
  p = 10*k;
  r = k ? outer : inner;
  Point(p+1) = {r, 0, 0};
  Point(p+2) = {s*r, s*r, 0};
  Point(p+3) = {0, r, 0};
  Point(p+4) = {0, s*r, s*r};
  Point(p+5) = {0, 0, r};
  Point(p+6) = {s*r, 0, s*r};
  Point(p+7) = {g*r, g*r, g*r};
  For i In {1:6}
    Circle(p+i) = {p+i, 100, p + (i == 6 ? 1 : i+1)};
  EndFor
  Circle(p+7) = {p+7, 100, p+2};
  Circle(p+8) = {p+7, 100, p+4};
  Circle(p+9) = {p+7, 100, p+6};
  Curve Loop(p+1) = {p+6, p+1, -(p+7), p+9};
  Curve Loop(p+2) = {p+2, p+3, -(p+8), p+7};
  Curve Loop(p+3) = {p+4, p+5, -(p+9), p+8};
  For i In {1:3}
    Surface(p+i) = {p+i} In Sphere {100};
  EndFor
EndFor

For i In {1:7}
  Line(20+i) = {i, 10+i};
EndFor
For i In {1:9}  // walls between the curves of both spheres
  a = i <= 6 ? i : 7;
  b = i <= 5 ? i+1 : (i == 6 ? 1 : 2*(i-6));
  Curve Loop(30+i) = {i, 20+b, -(10+i), -(20+a)};
  Plane Surface(30+i) = {30+i};
EndFor
Surface Loop(1) = {1, 11, 36, 31, 37, 39};
Surface Loop(2) = {2, 12, 32, 33, 38, 37};
Surface Loop(3) = {3, 13, 34, 35, 39, 38};
For i In {1:3}
  Volume(i) = {i};
EndFor

Transfinite Curve {1:9, 11:19} = n+1;
Transfinite Curve {21:27} = layers+1;
Transfinite Surface {:};
Recombine Surface {:};
Transfinite Volume {:};

Physical Volume("wall") = {1:3};
Physical Surface("inner") = {1:3};
Physical Surface("x") = {33, 34};  // in the plane x = 0, and so on
Physical Surface("y") = {35, 36};
Physical Surface("z") = {31, 32};
