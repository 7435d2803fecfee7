/** The 3D view of the cell, served by ourselves under `/cell/`. */
import './styles/index.css'
import { useComputedColorScheme } from '@mantine/core'
import { IconCube } from '@tabler/icons-react'
import { useEffect, useRef } from 'react'
import { watchHolding } from '../../api/grip'
import { useLive } from '../../api/live'
import { usePast } from '../../api/past'
import { PAGE } from '../../api/shown'
import { listenForStopKey } from '../../components/stopKey'
import { Empty } from '../../components/Empty'
import { PastMark } from './PastMark'

export function CellFrame({ isServed }: { isServed: boolean }) {
  const scheme = useComputedColorScheme('light')
  const generation = useLive((s) => s.generation)
  const isPast = usePast((s) => s.shown !== null && !s.shown.problem)
  const { frame, watch } = useHolding()
  if (!isServed) {
    return (
      <Empty icon={<IconCube size={28} stroke={1.4} aria-hidden />} title="No 3D view">
        This server was started without one.
      </Empty>
    )
  }
  const query = scheme === 'dark' ? '?darkMode&hideViserLogo' : '?hideViserLogo'
  // A new generation is a restarted server: its viser has another key, so the frame is loaded anew.
  return (
    <div className={isPast ? 'cell-view is-past' : 'cell-view'}>
      <iframe
        key={`${scheme}${generation}`}
        ref={frame}
        className="cell-frame"
        title="3D view of the cell"
        src={`/cell/${PAGE}/${query}`}
        onLoad={watch}
      />
      <PastMark />
    </div>
  )
}

/** Hears what is pressed in the view: the mouse for its handles, the key of STOP. */
function useHolding() {
  const frame = useRef<HTMLIFrameElement>(null)
  const stop = useRef<() => void>(undefined)
  useEffect(() => () => stop.current?.(), [])
  const watch = () => {
    stop.current?.()
    const view = frame.current?.contentWindow
    if (!view) return
    const ends = [watchHolding(view), listenForStopKey(view)]
    stop.current = () => ends.forEach((end) => end())
  }
  return { frame, watch }
}
