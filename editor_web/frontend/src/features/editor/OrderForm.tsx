/** The children of a container whose order means something, to be moved up and down. */
import { IconArrowDown, IconArrowUp } from '@tabler/icons-react'
import type { EditNode } from '../../document/editing/model'
import { choose, focusNode, reorder } from './actions'
import { Section } from './Section'

export function OrderForm({ node }: { node: EditNode }) {
  return (
    <Section title="Order of the children">
      <ol className="order-list">
        {node.children.map((child, index) => (
          <li key={child.name}>
            {child.role && <span className="card-role">{child.role}</span>}
            <button
              type="button"
              className="link"
              onClick={() => {
                choose([child.path])
                focusNode(child.path)
              }}
            >
              {child.name}
            </button>
            <span className="spacer" />
            <button
              type="button"
              className="mini"
              aria-label={`Move ${child.name} up`}
              disabled={index === 0}
              onClick={() => void reorder(node, child.name, -1)}
            >
              <IconArrowUp size={13} aria-hidden />
            </button>
            <button
              type="button"
              className="mini"
              aria-label={`Move ${child.name} down`}
              disabled={index === node.children.length - 1}
              onClick={() => void reorder(node, child.name, 1)}
            >
              <IconArrowDown size={13} aria-hidden />
            </button>
          </li>
        ))}
      </ol>
    </Section>
  )
}
