"""Tables of points, format by format: CODESYS, TwinCAT, Rockwell, SEW, Lenze, KAS, ISG, ROS 2, CSV."""
