/** The way from the root to the selected node. */
import { pathsTo } from '../document/tree'

export function Breadcrumb({ selected, onSelect }: { selected: string | undefined; onSelect: (path: string) => void }) {
  if (!selected) return null
  const paths = pathsTo(selected)
  return (
    <nav aria-label="Path of the selection" className="breadcrumb">
      <ol>
        {paths.map((path) => (
          <li key={path}>
            <button type="button" aria-current={path === selected ? 'location' : undefined} onClick={() => onSelect(path)}>
              {path.split('/').pop()}
            </button>
          </li>
        ))}
      </ol>
    </nav>
  )
}
