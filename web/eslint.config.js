// Rules for the page's modules and their tests: what is likely a mistake. The form is prettier's.
import js from '@eslint/js';
import globals from 'globals';

export default [
  { ignores: ['**/openbridge.js'] },
  js.configs.recommended,
  {
    languageOptions: { ecmaVersion: 2024, sourceType: 'module' },
    rules: {
      eqeqeq: ['error', 'always', { null: 'ignore' }],
      'no-shadow': 'error',
      'no-var': 'error',
      'prefer-const': 'error',
      'no-implied-eval': 'error',
      'no-unused-vars': ['error', { argsIgnorePattern: '^_' }],
    },
  },
  { files: ['**/static/*.js'], languageOptions: { globals: globals.browser } },
  { files: ['**/*.mjs', 'build.mjs', '*.js'], languageOptions: { globals: globals.node } },
];
