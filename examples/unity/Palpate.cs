// SPDX-License-Identifier: Apache-2.0
// palpate.h for C#, for Unity and for any other .NET: put this file and libpalpate (libpalpate.so, libpalpate.dll) into
// Assets/Plugins. Units are SI and the frame is that of the library: right-handed, metres. Errors are PalpateException.
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Palpate
{
    public sealed class PalpateException : Exception
    {
        public PalpateException(string message) : base(message) { }
    }

    /// Status bits of a step; palpate.h says what to do about each.
    [Flags]
    public enum Status : uint
    {
        Contact = 1u << 0, Activated = 1u << 1, Released = 1u << 2, Sliding = 1u << 3, AtBorder = 1u << 4, EnergyLimited = 1u << 5,
        BeyondDepth = 1u << 6, BadInput = 1u << 7, Dropped = 1u << 8, ForceLimited = 1u << 9, Awaiting = 1u << 10, SkinLags = 1u << 11
    }

    /// palpate_settings.
    [StructLayout(LayoutKind.Sequential)]
    public struct Settings
    {
        internal uint size;
        public double Friction;        // mu; negative: that of the certificate
        public double TankCap;         // J
        public double LipschitzBound;  // N/m; 0: that of the library
        public double SearchRate;      // Hz; 0: each step searches the whole body

        public static Settings Default
        {
            get
            {
                Settings settings;
                Native.palpate_settings_default(out settings);
                return settings;
            }
        }
    }

    /// palpate_library_info.
    [StructLayout(LayoutKind.Sequential)]
    public struct LibraryInfo
    {
        internal uint size;
        public int Vertices, Triangles;
        public double Stick, Slip, Friction, Depth;
        [MarshalAs(UnmanagedType.ByValArray, SizeConst = 3)] public double[] Low, High;
        public double MinLipschitzBound, LipschitzBound;
    }

    /// palpate_observation.
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Observation
    {
        internal uint size;
        public Status Status;
        public int Element;  // -1 without contact
        public fixed double ContactPoint[3], Natural[3], Normal[3];
        public double Depth, Lateral, Offset, Energy, Tank, Absorbed;
        public fixed double ForceOnBody[3], LateralOffset[3];
        public double Dissipated, RelaxedFraction;
    }

    /// palpate_deformation_info.
    [StructLayout(LayoutKind.Sequential)]
    public struct SkinInfo
    {
        internal uint size;
        public int Vertices, Triangles, Sites, Modes;
        public double Depth, Reach;
    }

    internal static unsafe class Native
    {
        const string Dll = "libpalpate";

        [DllImport(Dll)] internal static extern IntPtr palpate_last_error();
        [DllImport(Dll)] internal static extern IntPtr palpate_version();
        [DllImport(Dll)] internal static extern int palpate_library_load(byte[] path, out IntPtr library);
        [DllImport(Dll)] internal static extern int palpate_library_load_memory(byte[] bytes, UIntPtr size, out IntPtr library);
        [DllImport(Dll)] internal static extern void palpate_library_destroy(IntPtr library);
        [DllImport(Dll)] internal static extern int palpate_library_describe(IntPtr library, ref LibraryInfo info);
        [DllImport(Dll)] internal static extern int palpate_library_vertices(IntPtr library, double[] positions, UIntPtr capacity);
        [DllImport(Dll)] internal static extern int palpate_library_triangles(IntPtr library, int[] triangles, UIntPtr capacity);
        [DllImport(Dll)] internal static extern void palpate_settings_default(out Settings settings);
        [DllImport(Dll)] internal static extern int palpate_state_create(IntPtr library, ref Settings settings, out IntPtr state);
        [DllImport(Dll)] internal static extern void palpate_state_destroy(IntPtr state);
        [DllImport(Dll)] internal static extern void palpate_state_reset(IntPtr state);
        [DllImport(Dll)] internal static extern int palpate_state_set_pose(IntPtr state, double[] position, double[] rotation);
        [DllImport(Dll)] internal static extern uint palpate_step(IntPtr state, double* position, double* velocity, double dt, double* force);
        [DllImport(Dll)] internal static extern int palpate_observe(IntPtr state, ref Observation observation);
        [DllImport(Dll)] internal static extern int palpate_deformation_load(IntPtr library, byte[] path, out IntPtr deformation);
        [DllImport(Dll)] internal static extern void palpate_deformation_destroy(IntPtr deformation);
        [DllImport(Dll)] internal static extern int palpate_deformation_describe(IntPtr deformation, ref SkinInfo info);
        [DllImport(Dll)] internal static extern int palpate_deformation_triangles(IntPtr deformation, int[] triangles, UIntPtr capacity);
        [DllImport(Dll)] internal static extern int palpate_deform(IntPtr state, IntPtr deformation, double[] positions, UIntPtr capacity);

        internal static string TextOf(IntPtr text)
        {
            int length = 0;
            while (Marshal.ReadByte(text, length) != 0) ++length;
            byte[] bytes = new byte[length];
            Marshal.Copy(text, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        internal static byte[] PathOf(string path) { return Encoding.UTF8.GetBytes(path + "\0"); }

        internal static void Check(int result)
        {
            if (result < 0) throw new PalpateException(TextOf(palpate_last_error()));
        }

        internal static UIntPtr Size(int count) { return new UIntPtr((uint)count); }
    }

    /// A response library. Destroyed after its states and skins; any number of threads may use it.
    public sealed class Library : IDisposable
    {
        internal IntPtr Handle;
        public readonly LibraryInfo Info;

        /// A .plib, or a library.h5 where the runtime has HDF5.
        public Library(string path)
        {
            Native.Check(Native.palpate_library_load(Native.PathOf(path), out Handle));
            Info = Describe();
        }

        /// The bytes of a .plib, as a platform gives them that has its assets in an archive.
        public Library(byte[] bytes)
        {
            Native.Check(Native.palpate_library_load_memory(bytes, Native.Size(bytes.Length), out Handle));
            Info = Describe();
        }

        LibraryInfo Describe()
        {
            LibraryInfo info = new LibraryInfo { size = (uint)Marshal.SizeOf(typeof(LibraryInfo)) };
            Native.Check(Native.palpate_library_describe(Handle, ref info));
            return info;
        }

        public static string Version { get { return Native.TextOf(Native.palpate_version()); } }

        /// Three coordinates a vertex of the response surface.
        public double[] Vertices()
        {
            double[] positions = new double[3 * Info.Vertices];
            Native.Check(Native.palpate_library_vertices(Handle, positions, Native.Size(Info.Vertices)));
            return positions;
        }

        /// Three vertices a triangle, counter-clockwise seen from outside.
        public int[] Triangles()
        {
            int[] triangles = new int[3 * Info.Triangles];
            Native.Check(Native.palpate_library_triangles(Handle, triangles, Native.Size(Info.Triangles)));
            return triangles;
        }

        public void Dispose()
        {
            Native.palpate_library_destroy(Handle);
            Handle = IntPtr.Zero;
        }
    }

    /// One tool on one body, for one thread at a time. The step makes no garbage.
    public sealed unsafe class State : IDisposable
    {
        internal IntPtr Handle;

        public State(Library library) : this(library, Settings.Default) { }

        public State(Library library, Settings settings)
        {
            Native.Check(Native.palpate_state_create(library.Handle, ref settings, out Handle));
        }

        /// One step of the force loop: position (m) and velocity (m/s) of the tool tip, dt (s) since the last step, and the
        /// force of the body on the tool (N); three numbers each.
        public Status Step(double[] position, double[] velocity, double dt, double[] force)
        {
            if (position.Length < 3 || velocity.Length < 3 || force.Length < 3)
                throw new ArgumentException("Palpate.State.Step: an array has fewer than three numbers");
            fixed (double* x = position, v = velocity, f = force)
                return (Status)Native.palpate_step(Handle, x, v, dt, f);
        }

        public Observation Observe()
        {
            Observation seen = new Observation { size = (uint)sizeof(Observation) };
            Native.Check(Native.palpate_observe(Handle, ref seen));
            return seen;
        }

        /// x_world = rotation x_body + position; rotation: three rows.
        public void SetPose(double[] position, double[] rotation)
        {
            if (position.Length < 3 || rotation.Length < 9)
                throw new ArgumentException("Palpate.State.SetPose: a position has three numbers, a rotation nine");
            Native.Check(Native.palpate_state_set_pose(Handle, position, rotation));
        }

        public void Reset() { Native.palpate_state_reset(Handle); }

        public void Dispose()
        {
            Native.palpate_state_destroy(Handle);
            Handle = IntPtr.Zero;
        }
    }

    /// The skin of deformation.pdef.
    public sealed class Skin : IDisposable
    {
        internal IntPtr Handle;
        public readonly SkinInfo Info;

        public Skin(Library library, string path)
        {
            Native.Check(Native.palpate_deformation_load(library.Handle, Native.PathOf(path), out Handle));
            SkinInfo info = new SkinInfo { size = (uint)Marshal.SizeOf(typeof(SkinInfo)) };
            Native.Check(Native.palpate_deformation_describe(Handle, ref info));
            Info = info;
        }

        public int[] Triangles()
        {
            int[] triangles = new int[3 * Info.Triangles];
            Native.Check(Native.palpate_deformation_triangles(Handle, triangles, Native.Size(Info.Triangles)));
            return triangles;
        }

        /// Three coordinates a vertex, as the last step of the state left them. May be called beside the thread that steps.
        public void Deform(State state, double[] positions)
        {
            Native.Check(Native.palpate_deform(state.Handle, Handle, positions, Native.Size(positions.Length / 3)));
        }

        public void Dispose()
        {
            Native.palpate_deformation_destroy(Handle);
            Handle = IntPtr.Zero;
        }
    }
}
