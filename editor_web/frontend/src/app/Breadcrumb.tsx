/** The way from the root to the selected node. */
import { Anchor, Group } from '@mantine/core'
import { IconChevronRight } from '@tabler/icons-react'
import { pathsTo } from '../document/tree'

export function Breadcrumb({ selected, onSelect }: { selected: string | undefined; onSelect: (path: string) => void }) {
  if (!selected) return null
  return (
    <nav aria-label="Path of the selection" style={{ minWidth: 0, overflow: 'hidden' }}>
      <Group component="ol" className="plain-list" gap="4xs" wrap="nowrap" fz="0.8rem" c="var(--quiet)">
        {pathsTo(selected).map((path, level) => (
          <Group component="li" key={path} gap="4xs" wrap="nowrap">
            {level > 0 && <IconChevronRight size={12} aria-hidden />}
            <Anchor
              component="button"
              type="button"
              inherit
              underline="hover"
              c={path === selected ? 'var(--text)' : 'inherit'}
              aria-current={path === selected ? 'location' : undefined}
              onClick={() => onSelect(path)}
            >
              {path.split('/').pop()}
            </Anchor>
          </Group>
        ))}
      </Group>
    </nav>
  )
}
