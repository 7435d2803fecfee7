/** Everything that can hold the run: its breakpoints and locks, in one list. */
import { CloseButton } from '@mantine/core'
import { IconBookmarkOff } from '@tabler/icons-react'
import { editBreakpoints, useBreakpoints } from '../../api/breakpoints'
import { useLive } from '../../api/live'
import { Empty } from '../../components/Empty'
import { breakpointWords } from '../../document/breakpoints'
import { lookup } from '../../document/dict'
import type { Commands } from './useCommands'

export function Holds({ commands, onShow }: { commands: Commands; onShow: (path: string) => void }) {
  const breakpoints = useBreakpoints()
  const locks = useLive((s) => s.control?.locks)
  const reasons = useLive((s) => s.lockReasons)
  if (breakpoints.length === 0 && !locks?.length) {
    return (
      <Empty icon={<IconBookmarkOff size={26} stroke={1.4} aria-hidden />} title="Nothing holds this behavior">
        Click the dot at the corner of a node to pause there, or select a node for conditions and locks.
      </Empty>
    )
  }
  return (
    <ul className="plain-list holds">
      {breakpoints.map((each) => (
        <li key={`${each.path}|${each.when}`}>
          <span className="hold-dot" aria-hidden />
          <span className="hold-text">
            <button type="button" className="link" onClick={() => onShow(each.path)}>
              {each.path}
            </button>{' '}
            <span className="quiet">{breakpointWords(each)}</span>
          </span>
          <CloseButton
            size="sm"
            aria-label={`Remove the breakpoint ${each.when} ${each.path}`}
            onClick={() => void editBreakpoints((list) => list.filter((one) => one.path !== each.path || one.when !== each.when))}
          />
        </li>
      ))}
      {locks?.map((path) => (
        <li key={path}>
          <span className="hold-lock" aria-hidden />
          <span className="hold-text">
            <button type="button" className="link" onClick={() => onShow(path)}>
              {path}
            </button>{' '}
            <span className="quiet">locked{lookup(reasons, path) && `: ${lookup(reasons, path)}`}</span>
          </span>
          <CloseButton size="sm" aria-label={`Unlock ${path}`} onClick={() => void commands.unlock(path)} />
        </li>
      ))}
    </ul>
  )
}
