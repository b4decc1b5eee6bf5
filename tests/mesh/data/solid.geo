lc = 3;
Point(1) = {0,0,0,lc}; Point(2) = {1,0,0,lc}; Point(3) = {1,1,0,lc}; Point(4) = {0,1,0,lc};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
If (hex)
 Transfinite Curve{1,2,3,4} = 2; Transfinite Surface{1}; Recombine Surface{1};
 out[] = Extrude {0,0,2} { Surface{1}; Layers{2}; Recombine; };
Else
 out[] = Extrude {0,0,2} { Surface{1}; };
EndIf
If (tagged)
Physical Volume("solid") = {out[1]};
Physical Volume("again") = {out[1]};
Physical Surface("floor") = {1};
Physical Surface("ends") = {1, out[0]};
Physical Curve("edge") = {1};
Physical Point(7) = {1};
EndIf
