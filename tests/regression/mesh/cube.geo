// Box [0, LX] x [0, LY] x [0, LZ] of tetrahedra, N segments on an edge along x.
DefineConstant[ N = 3, LX = 1, LY = 1, LZ = 1 ];
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, LX, LY, LZ};
MeshSize{ PointsOf{ Volume{1}; } } = LX / N;
e = 1e-6 * LX;
left() = Surface In BoundingBox{-e, -e, -e, e, LY + e, LZ + e};
right() = Surface In BoundingBox{LX - e, -e, -e, LX + e, LY + e, LZ + e};
front() = Surface In BoundingBox{-e, -e, -e, LX + e, e, LZ + e};
back() = Surface In BoundingBox{-e, LY - e, -e, LX + e, LY + e, LZ + e};
bottom() = Surface In BoundingBox{-e, -e, -e, LX + e, LY + e, e};
top() = Surface In BoundingBox{-e, -e, LZ - e, LX + e, LY + e, LZ + e};
Physical Surface("LEFT") = {left()};
Physical Surface("RIGHT") = {right()};
Physical Surface("FRONT") = {front()};
Physical Surface("BACK") = {back()};
Physical Surface("BOTTOM") = {bottom()};
Physical Surface("TOP") = {top()};
Physical Volume("BODY") = {1};
