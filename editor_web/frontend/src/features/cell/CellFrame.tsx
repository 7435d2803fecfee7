/** The 3D view of the cell, served by ourselves under `/cell/`. */
import { useComputedColorScheme } from '@mantine/core'
import { IconCube } from '@tabler/icons-react'
import { useLive } from '../../api/live'
import { PAGE } from '../../api/shown'
import { Empty } from '../../components/Empty'

export function CellFrame({ isServed }: { isServed: boolean }) {
  const scheme = useComputedColorScheme('light')
  const generation = useLive((s) => s.generation)
  if (!isServed) {
    return (
      <Empty icon={<IconCube size={28} stroke={1.4} aria-hidden />} title="No 3D view">
        This server was started without one.
      </Empty>
    )
  }
  const query = scheme === 'dark' ? '?darkMode&hideViserLogo' : '?hideViserLogo'
  // A new generation is a restarted server: its viser has another key, so the frame is loaded anew.
  return <iframe key={`${scheme}${generation}`} className="cell-frame" title="3D view of the cell" src={`/cell/${PAGE}/${query}`} />
}
