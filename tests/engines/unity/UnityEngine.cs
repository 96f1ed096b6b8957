// SPDX-License-Identifier: AGPL-3.0-or-later
// What examples/unity calls of Unity, with its names and signatures, so that a test compiles and runs it without Unity.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }

    public class Component
    {
        readonly Dictionary<Type, object> components = new Dictionary<Type, object>();
        public readonly Transform transform;
        public Component() { transform = this as Transform ?? new Transform(); }
        public T GetComponent<T>() where T : class, new()
        {
            object found;
            if (!components.TryGetValue(typeof(T), out found)) components[typeof(T)] = found = new T();
            return (T)found;
        }
    }

    public class Behaviour : Component { }
    public class MonoBehaviour : Behaviour { }

    public class Transform : Component
    {
        public Vector3 position { get; set; }
        public Vector3 InverseTransformPoint(Vector3 p) { return new Vector3(p.x - position.x, p.y - position.y, p.z - position.z); }
    }

    public class MeshFilter : Component { public Mesh mesh { get; set; } }
    public class MeshRenderer : Component { }

    public class Mesh
    {
        public Rendering.IndexFormat indexFormat { get; set; }
        Vector3[] shown;
        public Vector3[] vertices { get { return (Vector3[])shown.Clone(); } set { shown = (Vector3[])value.Clone(); } }
        public int[] triangles { get; set; }
        public void MarkDynamic() { }
        public void RecalculateNormals() { }
        public void RecalculateBounds() { }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class RequireComponent : Attribute { public RequireComponent(Type first, Type second) { } }

    public static class Application { public static string streamingAssetsPath { get; set; } }
    public static class Time { public static float deltaTime { get { return 1f / 60; } } }
}

namespace UnityEngine.Rendering
{
    public enum IndexFormat { UInt16, UInt32 }
}
