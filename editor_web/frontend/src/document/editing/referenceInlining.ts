/** Putting the inside of behaviors that are referred to below their references, to be seen in place. Pure. */
import type { EditNode } from './model'

/** What is inside a document, by its id. */
export type InlinedDocuments = ReadonlyMap<string, EditNode>

const DEEPEST = 12
/** From what a child was made, so that what is up to date stays the same object. */
const madeOf = new WeakMap<EditNode, EditNode>()

/** The same graph with the insides that are known below their references; nodes that do not change stay the same objects. */
export function inlineReferences(root: EditNode, bodies: InlinedDocuments, depth = 0): EditNode {
  if (bodies.size === 0 || depth > DEEPEST) return root
  const body = root.kind === 'behavior' && root.document !== null ? bodies.get(root.document) : undefined
  if (body) {
    const known = root.children[0]
    if (known && madeOf.get(known) === body) return inlined(root, bodies, depth)
    const child = relocated(body, root)
    madeOf.set(child, body)
    return { ...root, children: [inlineReferences(child, bodies, depth + 1)] }
  }
  return inlined(root, bodies, depth)
}

function inlined(node: EditNode, bodies: InlinedDocuments, depth: number): EditNode {
  const children = node.children.map((child) => {
    const made = inlineReferences(child, bodies, depth + 1)
    const from = madeOf.get(child)
    if (from && made !== child) madeOf.set(made, from)
    return made
  })
  return children.some((child, index) => child !== node.children[index]) ? { ...node, children } : node
}

/** A body below a reference: paths go on from there, and the lines are those of the reference, which stands in this text. */
function relocated(body: EditNode, reference: EditNode): EditNode {
  return {
    ...body,
    path: `${reference.path}/${body.path}`,
    line: reference.line,
    column: reference.column,
    // No line is between them: nothing of this text belongs to it.
    end_line: reference.line - 1,
    children: body.children.map((child) => relocated(child, reference)),
  }
}

/** The reference around a node of another document, and where the node is there. */
export function enclosingReference(root: EditNode, path: string): { readonly reference: EditNode; readonly inner: string } | undefined {
  let found: { reference: EditNode; inner: string } | undefined
  let node: EditNode | undefined = root
  while (node && node.path !== path) {
    const next: EditNode | undefined = node.children.find((child) => path === child.path || path.startsWith(`${child.path}/`))
    if (node.kind === 'behavior') found = { reference: node, inner: path.slice(node.path.length + 1) }
    node = next
  }
  return found
}
